#pragma once

#include <optional>

#include <Eigen/Cholesky>
#include <Eigen/Core>

// Eigen's decompositions of the sizes that many files use, compiled once: each is seconds of every file that names it.
namespace semantic_mht_slam {

/// Inverse of a regular matrix: in closed form, the larger ones by LU decomposition with partial pivoting.
Eigen::Matrix3d inverted(const Eigen::Matrix3d& matrix);
Eigen::Matrix<double, 6, 6> inverted(const Eigen::Matrix<double, 6, 6>& matrix);
Eigen::MatrixXd inverted(const Eigen::MatrixXd& matrix);

/// x of `matrix` x = b, where `matrix` is symmetric and positive or negative semidefinite (LDL^T).
Eigen::Vector3d solved(const Eigen::Matrix3d& matrix, const Eigen::Vector3d& b);
Eigen::Matrix<double, 6, 1> solved(const Eigen::Matrix<double, 6, 6>& matrix, const Eigen::Matrix<double, 6, 1>& b);

/// Upper triangular U with U^T U = `matrix`, which is symmetric and positive definite: |U e|^2 = e^T matrix e.
Eigen::Matrix2d upperSquareRoot(const Eigen::Matrix2d& matrix);
Eigen::Matrix3d upperSquareRoot(const Eigen::Matrix3d& matrix);
Eigen::Matrix<double, 6, 6> upperSquareRoot(const Eigen::Matrix<double, 6, 6>& matrix);

/// Cholesky factor of a symmetric matrix; none if it is not positive definite.
std::optional<Eigen::LLT<Eigen::MatrixXd>> choleskyOf(const Eigen::MatrixXd& matrix);

/// Eigenvalues in rising order and the eigenvectors, unit columns, of a symmetric matrix.
struct SymmetricEigen {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};
SymmetricEigen symmetricEigen(const Eigen::MatrixXd& matrix);

}  // namespace semantic_mht_slam
