#include "outer_alignment.h"

#include <algorithm>
#include <cmath>

namespace semantic_mht_slam {
namespace {

constexpr double kMostYawStddev_rad = 0.06;  // of a frame that is determined
constexpr double kAgreeSq = 9.0;             // squared distance in units of the variance
constexpr std::size_t kTriedPoints = 24;     // of which each two make a hypothesis
constexpr int kRefinements = 12;
constexpr double kLeastBaseline = 3.0;  // standard deviations between two points of a hypothesis

struct PlanarAlignment {
  double yaw_rad = 0.0;
  Eigen::Vector2d translation_m = Eigen::Vector2d::Zero();

  Eigen::Vector2d operator*(const Eigen::Vector3d& point_m) const {
    return Eigen::Rotation2Dd(yaw_rad) * Eigen::Vector2d(point_m.head<2>()) + translation_m;
  }
};

double varianceOf(const PointPair& pair) {
  return 0.5 * pair.cov_m2.topLeftCorner<2, 2>().trace();
}

double distanceSq(const PlanarAlignment& alignment, const PointPair& pair) {
  return (alignment * pair.in_world_m - pair.measured_m.head<2>()).squaredNorm() / varianceOf(pair);
}

/// What does not agree counts as much as what just does not.
double penaltyOf(const PlanarAlignment& alignment, const std::vector<PointPair>& pairs) {
  double penalty = 0.0;
  for (const PointPair& pair : pairs) penalty += std::min(kAgreeSq, distanceSq(alignment, pair));
  return penalty;
}

/// By two points alone; empty if they lie too close together.
std::optional<PlanarAlignment> throughTwo(const PointPair& a, const PointPair& b) {
  const Eigen::Vector2d world_m = (b.in_world_m - a.in_world_m).head<2>();
  const Eigen::Vector2d outer_m = (b.measured_m - a.measured_m).head<2>();
  const double noise_m = std::sqrt(varianceOf(a) + varianceOf(b));
  if (world_m.norm() < kLeastBaseline * noise_m || outer_m.norm() < noise_m) return std::nullopt;
  PlanarAlignment alignment;
  alignment.yaw_rad = std::atan2(outer_m.y(), outer_m.x()) - std::atan2(world_m.y(), world_m.x());
  alignment.translation_m =
      0.5 * (a.measured_m.head<2>() - alignment * a.in_world_m + b.measured_m.head<2>() - alignment * b.in_world_m);
  return alignment;
}

std::optional<PlanarAlignment> bestOfTwo(const std::vector<PointPair>& pairs) {
  const std::size_t tried = std::min(kTriedPoints, pairs.size());
  const auto nth = [&](std::size_t i) -> const PointPair& { return pairs[i * (pairs.size() - 1) / (tried - 1)]; };
  std::optional<PlanarAlignment> best;
  double least = 0.0;
  for (std::size_t i = 0; i < tried; ++i) {
    for (std::size_t j = i + 1; j < tried; ++j) {
      const auto alignment = throughTwo(nth(i), nth(j));
      if (!alignment) continue;
      const double penalty = penaltyOf(*alignment, pairs);
      if (best && penalty >= least) continue;
      best = alignment;
      least = penalty;
    }
  }
  return best;
}

/// What the pairs together say, each with the weight that a Cauchy loss gives it at the alignment before.
struct Weighted {
  double sum = 0.0;
  Eigen::Vector2d world_m = Eigen::Vector2d::Zero();
  Eigen::Vector2d outer_m = Eigen::Vector2d::Zero();
  double spread = 0.0;  ///< of the points about their centre, in units of the variances
  PlanarAlignment alignment;
};

Weighted refined(const PlanarAlignment& before, const std::vector<PointPair>& pairs) {
  std::vector<double> weights;
  Weighted result;
  for (const PointPair& pair : pairs) {
    const double weight = 1.0 / (varianceOf(pair) * (1.0 + distanceSq(before, pair)));
    weights.push_back(weight);
    result.sum += weight;
    result.world_m += weight * pair.in_world_m.head<2>();
    result.outer_m += weight * pair.measured_m.head<2>();
  }
  result.world_m /= result.sum;
  result.outer_m /= result.sum;
  double along = 0.0;
  double across = 0.0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const Eigen::Vector2d a = pairs[i].in_world_m.head<2>() - result.world_m;
    const Eigen::Vector2d b = pairs[i].measured_m.head<2>() - result.outer_m;
    along += weights[i] * a.dot(b);
    across += weights[i] * (a.x() * b.y() - a.y() * b.x());
    result.spread += weights[i] * a.squaredNorm();
  }
  result.alignment.yaw_rad = std::atan2(across, along);
  result.alignment.translation_m = result.outer_m - Eigen::Rotation2Dd(result.alignment.yaw_rad) * result.world_m;
  return result;
}

/// The offset between the two heights, of the pairs that agree in the plane.
double heightOf(const PlanarAlignment& alignment, const std::vector<PointPair>& pairs) {
  double sum = 0.0;
  double weights = 0.0;
  for (const PointPair& pair : pairs) {
    const double weight = 1.0 / (pair.cov_m2(2, 2) * (1.0 + distanceSq(alignment, pair)));
    sum += weight * (pair.measured_m.z() - pair.in_world_m.z());
    weights += weight;
  }
  return sum / weights;
}

}  // namespace

std::optional<Pose> alignOuterFrame(const std::vector<PointPair>& pairs) {
  if (pairs.size() < kFewestPairs) return std::nullopt;
  const std::optional<PlanarAlignment> first = bestOfTwo(pairs);
  if (!first) return std::nullopt;
  Weighted estimate;
  estimate.alignment = *first;
  for (int i = 0; i < kRefinements; ++i) estimate = refined(estimate.alignment, pairs);
  const auto agree = static_cast<std::size_t>(std::count_if(pairs.begin(), pairs.end(), [&](const PointPair& pair) {
    return distanceSq(estimate.alignment, pair) <= kAgreeSq;
  }));
  if (agree < kFewestPairs || 2 * agree <= pairs.size()) return std::nullopt;
  if (!(estimate.spread * kMostYawStddev_rad * kMostYawStddev_rad >= 1.0)) return std::nullopt;
  const PlanarAlignment& alignment = estimate.alignment;
  return Pose{expRotation({0.0, 0.0, alignment.yaw_rad}),
              {alignment.translation_m.x(), alignment.translation_m.y(), heightOf(alignment, pairs)}};
}

}  // namespace semantic_mht_slam
