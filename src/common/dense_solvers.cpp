#include "semantic_mht_slam/common/dense_solvers.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace semantic_mht_slam {

Eigen::Matrix3d inverted(const Eigen::Matrix3d& matrix) {
  return matrix.inverse();
}

Eigen::Matrix<double, 6, 6> inverted(const Eigen::Matrix<double, 6, 6>& matrix) {
  return matrix.inverse();
}

Eigen::MatrixXd inverted(const Eigen::MatrixXd& matrix) {
  return matrix.inverse();
}

Eigen::Vector3d solved(const Eigen::Matrix3d& matrix, const Eigen::Vector3d& b) {
  return matrix.ldlt().solve(b);
}

Eigen::Matrix<double, 6, 1> solved(const Eigen::Matrix<double, 6, 6>& matrix, const Eigen::Matrix<double, 6, 1>& b) {
  return matrix.ldlt().solve(b);
}

Eigen::Matrix2d upperSquareRoot(const Eigen::Matrix2d& matrix) {
  return matrix.llt().matrixU();
}

Eigen::Matrix3d upperSquareRoot(const Eigen::Matrix3d& matrix) {
  return matrix.llt().matrixU();
}

Eigen::Matrix<double, 6, 6> upperSquareRoot(const Eigen::Matrix<double, 6, 6>& matrix) {
  return matrix.llt().matrixU();
}

std::optional<Eigen::LLT<Eigen::MatrixXd>> choleskyOf(const Eigen::MatrixXd& matrix) {
  Eigen::LLT<Eigen::MatrixXd> factor(matrix);
  if (factor.info() != Eigen::Success) return std::nullopt;
  return factor;
}

SymmetricEigen symmetricEigen(const Eigen::MatrixXd& matrix) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

}  // namespace semantic_mht_slam
