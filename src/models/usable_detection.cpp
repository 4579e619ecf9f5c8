#include "semantic_mht_slam/models/usable_detection.h"

#include <algorithm>

#include <Eigen/Eigenvalues>

#include "semantic_mht_slam/common/gaussian.h"

namespace semantic_mht_slam {
namespace {

constexpr double kFarthest_m = 1e5;    // beyond what any sensor sees
constexpr double kLeastRange_m = 1.0;  // a deviation below which says something of any detection
constexpr double kLeastVariance_m2 = 1e-12;
constexpr double kLeastVarianceRatio = 1e-12;  // below it rounding alone decides whether a matrix is singular

template <class Predicate>
std::size_t removeIf(Detections& detections, const Predicate& isUnwanted) {
  const auto unwanted = std::remove_if(detections.begin(), detections.end(), isUnwanted);
  const auto count = static_cast<std::size_t>(detections.end() - unwanted);
  detections.erase(unwanted, detections.end());
  return count;
}

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
  if (detection.size_m && !(detection.size_m->array() >= 0.0 && detection.size_m->array() <= kFarthest_m).all()) {
    return false;
  }
  return !detection.cov_m2 || isUsableCov(*detection.cov_m2);
}

std::size_t removeAtOrigin(Detections& detections) {
  return removeIf(detections, [](const Detection& d) { return d.position_m.isZero(0.0); });
}

std::size_t forgetUnknownCovariances(Detections& detections) {
  std::size_t count = 0;
  for (Detection& detection : detections) {
    if (!detection.cov_m2 || !detection.cov_m2->allFinite()) continue;
    const double range_m = std::max(detection.position_m.norm(), kLeastRange_m);
    const Eigen::Vector3d variance_m2 = detection.cov_m2->diagonal();
    if (variance_m2.minCoeff() > 0.0 && variance_m2.maxCoeff() <= range_m * range_m) continue;
    detection.cov_m2.reset();
    ++count;
  }
  return count;
}

std::size_t removeUnusable(Detections& detections) {
  return removeIf(detections, [](const Detection& d) { return !isUsable(d); });
}

}  // namespace semantic_mht_slam
