#include "semantic_mht_slam/models/usable_detection.h"

#include <algorithm>

#include <Eigen/Eigenvalues>

#include "semantic_mht_slam/common/gaussian.h"

namespace semantic_mht_slam {
namespace {

constexpr double kFarthest_m = 1e5;  // beyond what any sensor sees
constexpr double kLeastVariance_m2 = 1e-12;
constexpr double kLeastVarianceRatio = 1e-12;  // below it rounding alone decides whether a matrix is singular

bool isUsableCov(const Eigen::Matrix3d& cov_m2) {
  if (!isCovariance(cov_m2)) return false;
  const Eigen::Vector3d variances_m2 =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(cov_m2, Eigen::EigenvaluesOnly).eigenvalues();
  const double least_m2 = variances_m2.minCoeff();
  const double largest_m2 = variances_m2.maxCoeff();
  return largest_m2 <= kFarthest_m * kFarthest_m &&
         least_m2 >= std::max(kLeastVariance_m2, kLeastVarianceRatio * largest_m2);
}

}  // namespace

bool isUsable(const Detection& detection) {
  if (!(detection.position_m.cwiseAbs().array() <= kFarthest_m).all()) return false;
  if (detection.score && !(*detection.score >= 0.0 && *detection.score <= 1.0)) return false;
  if (detection.size_m && !(detection.size_m->allFinite() && (detection.size_m->array() >= 0.0).all())) return false;
  return !detection.cov_m2 || isUsableCov(*detection.cov_m2);
}

std::size_t removeUnusable(Detections& detections) {
  const auto unusable =
      std::remove_if(detections.begin(), detections.end(), [](const Detection& d) { return !isUsable(d); });
  const auto count = static_cast<std::size_t>(detections.end() - unusable);
  detections.erase(unusable, detections.end());
  return count;
}

}  // namespace semantic_mht_slam
