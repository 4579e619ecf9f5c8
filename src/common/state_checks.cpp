#include "semantic_mht_slam/common/state_checks.h"

#include "semantic_mht_slam/common/dense_solvers.h"

namespace semantic_mht_slam {
namespace {

bool isSymmetric(const Eigen::MatrixXd& matrix) {
  if (matrix.rows() != matrix.cols() || !matrix.allFinite()) return false;
  if (matrix.size() == 0) return true;
  return (matrix - matrix.transpose()).cwiseAbs().maxCoeff() <= kRounding * matrix.cwiseAbs().maxCoeff();
}

}  // namespace

bool isPositive(const Eigen::MatrixXd& matrix) {
  return isSymmetric(matrix) && choleskyOf(matrix);
}

bool isNotNegative(const Eigen::MatrixXd& matrix) {
  if (!isSymmetric(matrix)) return false;
  if (matrix.size() == 0) return true;
  const double least = symmetricEigen(matrix).values.minCoeff();
  return least >= -kRounding * matrix.cwiseAbs().maxCoeff();
}

}  // namespace semantic_mht_slam
