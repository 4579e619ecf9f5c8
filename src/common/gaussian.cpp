#include "semantic_mht_slam/common/gaussian.h"

#include <cmath>

#include <Eigen/Cholesky>

namespace semantic_mht_slam {

bool isCovariance(const Eigen::Matrix3d& matrix) {
  if (!matrix.allFinite()) return false;
  const double scale = matrix.cwiseAbs().maxCoeff();
  if ((matrix - matrix.transpose()).cwiseAbs().maxCoeff() > 1e-9 * scale) return false;
  return Eigen::LLT<Eigen::Matrix3d>(matrix).info() == Eigen::Success;
}

std::optional<GaussianEvaluation> evaluate(const Gaussian3& gaussian, const Eigen::Vector3d& point_m) {
  // Cholesky by hand: this is the innermost step of data association, and one logarithm serves the whole determinant.
  const Eigen::Matrix3d& c = gaussian.cov_m2;
  const Eigen::Vector3d d = point_m - gaussian.mean_m;
  const double pivot0 = c(0, 0);
  if (!(pivot0 > 0.0)) return std::nullopt;
  const double root0 = std::sqrt(pivot0);
  const double l10 = c(1, 0) / root0;
  const double l20 = c(2, 0) / root0;
  const double pivot1 = c(1, 1) - l10 * l10;
  if (!(pivot1 > 0.0)) return std::nullopt;
  const double root1 = std::sqrt(pivot1);
  const double l21 = (c(2, 1) - l20 * l10) / root1;
  const double pivot2 = c(2, 2) - l20 * l20 - l21 * l21;
  if (!(pivot2 > 0.0)) return std::nullopt;
  const double y0 = d.x() / root0;
  const double y1 = (d.y() - l10 * y0) / root1;
  const double y2_root2 = d.z() - l20 * y0 - l21 * y1;
  const double mahalanobis_sq = y0 * y0 + y1 * y1 + y2_root2 * y2_root2 / pivot2;
  const double log_det = std::log(pivot0 * pivot1 * pivot2);
  return GaussianEvaluation{mahalanobis_sq, -0.5 * (mahalanobis_sq + log_det) - 1.5 * kLogTwoPi};
}

}  // namespace semantic_mht_slam
