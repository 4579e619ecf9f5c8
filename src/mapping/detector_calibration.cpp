#include "semantic_mht_slam/mapping/detector_calibration.h"

#include <algorithm>
#include <cmath>

namespace semantic_mht_slam {
namespace {

constexpr double kSmallest = 1e-4;
constexpr double kBinRatio = 1.05;
constexpr double kMedianToStddev = 1.4826;  // of |x|, x normal
// |difference of two frames' horizontal residual|, Rayleigh distributed: median = stddev sqrt(2 log 2)
constexpr double kRayleighMedian = 1.17741;
constexpr double kMiddleRange_m = 20.0;
constexpr double kReachSigmas = 3.0;   // of the difference of two detections
constexpr double kLargestReach = 2.0;  // times the configured one

int binOf(double value) {
  return static_cast<int>(std::floor(std::log(value / kSmallest) / std::log(kBinRatio)));
}

/// Index of the nearest position of the same class; -1 if none is within `max_distance_m`.
int nearest(const Eigen::Vector3d& position_m, ClassIndex class_index, const std::vector<Eigen::Vector3d>& positions_m,
            const std::vector<ClassIndex>& classes, double max_distance_m) {
  int best = -1;
  double best_sq = max_distance_m * max_distance_m;
  for (std::size_t i = 0; i < positions_m.size(); ++i) {
    if (classes[i] != class_index) continue;
    const double distance_sq = (positions_m[i] - position_m).squaredNorm();
    if (distance_sq >= best_sq) continue;
    best_sq = distance_sq;
    best = static_cast<int>(i);
  }
  return best;
}

}  // namespace

void describe(CalibrationConfig& config, Fields& fields) {
  fields.add("enabled", config.enabled, "false: the class table's noise is used as it is (the paper).");
  fields.add("prior_samples", config.prior_samples, "", {1, 100000},
             "How many measurements the class table counts for.");
  fields.add("lag_frames", config.lag_frames, "frames", {2, 100}, "Distance of the frames that show the wander.");
  fields.add("max_distance", config.max_distance_m, "m", {0.1, 100.0},
             "Neighbours further apart are not compared, unless the class is so noisy that many would be missed.");
  fields.add("min_stddev", config.min_stddev_m, "m", {1e-3, 10.0}, "Noise is never taken to be below this.");
  fields.add(
      "min_share", config.min_share, "", {0.0, 1.0},
      "Share of the detections that must have a neighbour in the frame before; a detector that shows objects less "
      "often keeps the class table's noise.");
}

void RunningMedian::add(double value, int count) {
  const int bin = std::clamp(binOf(std::max(value, kSmallest)), 0, kBins - 1);
  bins_[static_cast<std::size_t>(bin)] += count;
  count_ += count;
  if (bin < median_bin_) below_ += count;
  moveToMedian();
}

/// To the first bin that, with those below, holds half of the values.
void RunningMedian::moveToMedian() {
  while (median_bin_ > 0 && 2 * below_ >= count_) below_ -= bins_[static_cast<std::size_t>(--median_bin_)];
  while (median_bin_ + 1 < kBins && 2 * (below_ + bins_[static_cast<std::size_t>(median_bin_)]) < count_) {
    below_ += bins_[static_cast<std::size_t>(median_bin_++)];
  }
}

double RunningMedian::median() const {
  return kSmallest * std::pow(kBinRatio, median_bin_ + 0.5);
}

DetectorCalibration::DetectorCalibration(const CalibrationConfig& config, const ClassTable& classes)
    : config_(config), statistics_(static_cast<std::size_t>(classes.size())) {
  const double to_median = std::sqrt(2.0) / kMedianToStddev;
  for (int c = 0; c < classes.size(); ++c) {
    const ClassInfo& info = classes[c];
    ClassStatistics& statistics = statistics_[static_cast<std::size_t>(c)];
    for (auto& directions : statistics.noise) {
      directions[0].add(info.range_stddev_m * to_median, config.prior_samples);
      directions[1].add(info.lateral_stddev_m * to_median, config.prior_samples);
      directions[2].add(info.lateral_stddev_m * to_median, config.prior_samples);
    }
    statistics.wander.add(info.lateral_stddev_m * std::sqrt(2.0) * kRayleighMedian, config.prior_samples);
    statistics.wander_distance_m.add(1.0, 1);
  }
}

int DetectorCalibration::rangeBin(double range_m) {
  return range_m < 15.0 ? 0 : range_m < 25.0 ? 1 : 2;
}

void DetectorCalibration::add(const Pose& T_odom_base, const Detections& detections) {
  if (!config_.enabled) return;
  PastFrame now;
  now.T_odom_base = T_odom_base;
  for (const Detection& detection : detections) {
    now.positions_m.push_back(detection.position_m);
    now.classes.push_back(detection.class_index);
  }
  if (!past_.empty()) learnNoise(past_.back(), now);
  if (static_cast<int>(past_.size()) == config_.lag_frames) {
    learnWander(past_.front(), now);
    past_.pop_front();
  }
  past_.push_back(std::move(now));
}

/// How far apart neighbours are compared, by class: of those of a noisy class a fixed distance would let only the near
/// ones through, and the noise would seem to be less.
std::vector<double> DetectorCalibration::reaches() const {
  std::vector<double> reaches_m;
  for (std::size_t c = 0; c < statistics_.size(); ++c) {
    const double stddev_m = noiseStddev(static_cast<ClassIndex>(c), kMiddleRange_m).head<2>().maxCoeff();
    reaches_m.push_back(std::clamp<double>(kReachSigmas * std::sqrt(2.0) * stddev_m, config_.max_distance_m,
                                           kLargestReach * config_.max_distance_m));
  }
  return reaches_m;
}

std::vector<DetectorCalibration::Neighbours> DetectorCalibration::neighbours(const PastFrame& past,
                                                                             const PastFrame& now) const {
  const Pose T_now_past = now.T_odom_base.inverse() * past.T_odom_base;
  std::vector<Eigen::Vector3d> expected_m;
  for (const Eigen::Vector3d& position_m : past.positions_m) expected_m.push_back(T_now_past * position_m);
  const std::vector<double> reaches_m = reaches();
  std::vector<Neighbours> result;
  for (std::size_t i = 0; i < now.positions_m.size(); ++i) {
    const Eigen::Vector3d& position_m = now.positions_m[i];
    const double reach_m = reaches_m[static_cast<std::size_t>(now.classes[i])];
    const int j = nearest(position_m, now.classes[i], expected_m, past.classes, reach_m);
    if (j < 0) continue;
    const auto k = static_cast<std::size_t>(j);
    const int back = nearest(expected_m[k], now.classes[i], now.positions_m, now.classes, reach_m);
    if (back == static_cast<int>(i)) result.push_back({now.classes[i], position_m, position_m - expected_m[k]});
  }
  return result;
}

void DetectorCalibration::learnNoise(const PastFrame& past, const PastFrame& now) {
  const std::vector<Neighbours> pairs = neighbours(past, now);
  detections_ += now.classes.size();
  neighbours_ += pairs.size();
  if (static_cast<double>(neighbours_) < config_.min_share * static_cast<double>(detections_)) return;
  for (const auto& [class_index, position_m, residual_m] : pairs) {
    const double range_m = position_m.head<2>().norm();
    if (range_m < 1e-3) continue;
    const Eigen::Vector2d ray = position_m.head<2>() / range_m;
    auto& directions =
        statistics_[static_cast<std::size_t>(class_index)].noise[static_cast<std::size_t>(rangeBin(range_m))];
    directions[0].add(std::abs(residual_m.head<2>().dot(ray)));
    directions[1].add(std::abs(residual_m.y() * ray.x() - residual_m.x() * ray.y()));
    directions[2].add(std::abs(residual_m.z()));
  }
}

void DetectorCalibration::learnWander(const PastFrame& past, const PastFrame& now) {
  const double driven_m = (now.T_odom_base.inverse() * past.T_odom_base).translation_m.norm();
  if (driven_m < 1.0) return;  // at a stop nothing wanders
  for (const auto& [class_index, position_m, residual_m] : neighbours(past, now)) {
    ClassStatistics& statistics = statistics_[static_cast<std::size_t>(class_index)];
    statistics.wander.add(residual_m.head<2>().norm());
    statistics.wander_distance_m.add(driven_m);
  }
}

Eigen::Vector3d DetectorCalibration::noiseStddev(ClassIndex class_index, double range_m) const {
  const auto& directions =
      statistics_[static_cast<std::size_t>(class_index)].noise[static_cast<std::size_t>(rangeBin(range_m))];
  Eigen::Vector3d stddev_m;
  for (int i = 0; i < 3; ++i) {
    stddev_m[i] = directions[static_cast<std::size_t>(i)].median() * kMedianToStddev / std::sqrt(2.0);
  }
  return stddev_m.cwiseMax(config_.min_stddev_m);
}

double DetectorCalibration::wanderVariancePerMetre(ClassIndex class_index) const {
  if (!config_.enabled) return 0.0;
  const ClassStatistics& statistics = statistics_[static_cast<std::size_t>(class_index)];
  const double lagged_stddev_m = statistics.wander.median() / kRayleighMedian;
  const Eigen::Vector3d white_m = noiseStddev(class_index, kMiddleRange_m);
  const double white_variance_m2 = white_m[0] * white_m[0] + white_m[1] * white_m[1];  // two frames, mean direction
  const double added_m2 = lagged_stddev_m * lagged_stddev_m - white_variance_m2;
  return std::max(0.0, added_m2) / statistics.wander_distance_m.median();
}

}  // namespace semantic_mht_slam
