#include "semantic_mht_slam/common/state_checks.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace semantic_mht_slam {
namespace {

template <class Matrix>
bool isSymmetric(const Matrix& matrix) {
  if (matrix.rows() != matrix.cols() || !matrix.allFinite()) return false;
  if (matrix.size() == 0) return true;
  return (matrix - matrix.transpose()).cwiseAbs().maxCoeff() <= kRounding * matrix.cwiseAbs().maxCoeff();
}

}  // namespace

template <class Matrix>
bool isPositive(const Matrix& matrix) {
  return isSymmetric(matrix) && matrix.llt().info() == Eigen::Success;
}

template <class Matrix>
bool isNotNegative(const Matrix& matrix) {
  if (!isSymmetric(matrix)) return false;
  if (matrix.size() == 0) return true;
  const Eigen::SelfAdjointEigenSolver<Matrix> solver(matrix, Eigen::EigenvaluesOnly);
  return solver.info() == Eigen::Success &&
         solver.eigenvalues().minCoeff() >= -kRounding * matrix.cwiseAbs().maxCoeff();
}

template bool isPositive(const Eigen::Matrix2d&);
template bool isPositive(const Eigen::Matrix3d&);
template bool isPositive(const Eigen::Matrix4d&);
template bool isPositive(const Eigen::Matrix<double, 6, 6>&);
template bool isPositive(const Eigen::MatrixXd&);
template bool isNotNegative(const Eigen::Matrix4d&);
template bool isNotNegative(const Eigen::Matrix<double, 6, 6>&);
template bool isNotNegative(const Eigen::MatrixXd&);

}  // namespace semantic_mht_slam
