#pragma once

#include <vector>

#include <Eigen/Core>

#include "edge_residuals.h"

namespace semantic_mht_slam {

/// Symmetric positive definite matrix of 6 x 6 blocks, most of which are zero; its Cholesky factor; and those blocks of
/// its inverse where the factor has some, without the others (Takahashi, Fagan, Chen, Formation of a sparse bus
/// impedance matrix, 1973). The diagonal blocks of the inverse are the marginal covariances of poses.
class BlockCholesky {
 public:
  /// A matrix of zeros of `size` blocks a side. Blocks may be added for any two members of one of the `cliques`, and
  /// the inverse is known there.
  BlockCholesky(int size, const std::vector<std::vector<int>>& cliques);

  /// Adds to a block of the matrix, and its transpose to the one across the diagonal.
  void add(int row, int column, const Matrix6d& block);

  /// Puts the factor in the place of the matrix; false if the matrix is not positive definite.
  [[nodiscard]] bool factorize();

  /// The solution for any number of columns of 6 * size rows; after `factorize`.
  Eigen::MatrixXd solve(const Eigen::MatrixXd& right) const;

  /// Puts the inverse in the place of the factor.
  void invert();

  /// A block of the inverse.
  Matrix6d inverse(int row, int column) const;

 private:
  /// Below the diagonal, by rising rows; what it holds is of the matrix, the factor or the inverse.
  struct Column {
    std::vector<int> rows;
    std::vector<Matrix6d> blocks;
    Matrix6d diagonal = Matrix6d::Zero();  ///< of the factor: its inverse

    std::size_t find(int row) const;
  };

  std::vector<int> position_;  ///< of each block in the order of elimination
  std::vector<Column> columns_;
};

}  // namespace semantic_mht_slam
