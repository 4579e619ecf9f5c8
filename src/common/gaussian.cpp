#include "semantic_mht_slam/common/gaussian.h"

#include <cmath>

#include <Eigen/Cholesky>

namespace semantic_mht_slam {
namespace {

constexpr double kLogTwoPi = 1.8378770664093454836;

}  // namespace

bool isCovariance(const Eigen::Matrix3d& matrix) {
  if (!matrix.allFinite()) return false;
  const double scale = matrix.cwiseAbs().maxCoeff();
  if ((matrix - matrix.transpose()).cwiseAbs().maxCoeff() > 1e-9 * scale) return false;
  return Eigen::LLT<Eigen::Matrix3d>(matrix).info() == Eigen::Success;
}

std::optional<GaussianEvaluation> evaluate(const Gaussian3& gaussian, const Eigen::Vector3d& point_m) {
  const Eigen::LLT<Eigen::Matrix3d> factor(gaussian.cov_m2);
  if (factor.info() != Eigen::Success) return std::nullopt;
  const Eigen::Vector3d whitened = factor.matrixL().solve(point_m - gaussian.mean_m);
  const Eigen::Matrix3d lower = factor.matrixL();
  const double half_log_det = std::log(lower(0, 0)) + std::log(lower(1, 1)) + std::log(lower(2, 2));
  const double mahalanobis_sq = whitened.squaredNorm();
  return GaussianEvaluation{mahalanobis_sq, -0.5 * mahalanobis_sq - half_log_det - 1.5 * kLogTwoPi};
}

}  // namespace semantic_mht_slam
