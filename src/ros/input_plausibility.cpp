#include "semantic_mht_slam/ros/input_plausibility.h"

#include <algorithm>

namespace semantic_mht_slam {
namespace {

constexpr std::size_t kLastSteps = 50;  // steps or frames
constexpr std::size_t kEnough = 20;
constexpr std::size_t kEnoughCompared = 3;
constexpr double kDriven_m = 5.0;  // between two frames that are compared
constexpr double kSamePlace_m = 0.5;
constexpr double kFastest_m_per_s = 100.0;       // of anything on the ground
constexpr double kFarthestDetection_m = 1000.0;  // of anything that a robot's sensor detects
constexpr double kHigh_m = 3.0;
constexpr double kOnEnd = 1.5;  // times as high as far
constexpr double kMost = 0.7;   // of the objects
constexpr double kFew = 0.3;

void keep(double value, std::deque<double>& values) {
  values.push_back(value);
  if (values.size() > kLastSteps) values.pop_front();
}

double medianOf(const std::deque<double>& values, std::size_t enough) {
  if (values.size() < enough) return 0.0;
  std::vector<double> sorted(values.begin(), values.end());
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  return *middle;
}

/// Share of the points that one of the others is near to.
double shareNear(const std::vector<Eigen::Vector3d>& points_m, const std::vector<Eigen::Vector3d>& others_m) {
  const auto isNear = [&](const Eigen::Vector3d& point_m) {
    return std::any_of(others_m.begin(), others_m.end(),
                       [&](const Eigen::Vector3d& other_m) { return (point_m - other_m).norm() < kSamePlace_m; });
  };
  const auto near = std::count_if(points_m.begin(), points_m.end(), isNear);
  return static_cast<double>(near) / static_cast<double>(points_m.size());
}

}  // namespace

bool InputOddities::isOdometryInMillimetres() const {
  return speed_m_per_s > kFastest_m_per_s;
}

bool InputOddities::areObjectsInMillimetres() const {
  return range_m > kFarthestDetection_m;
}

bool InputOddities::areObjectsOnEnd() const {
  return height_m > kHigh_m && height_m > kOnEnd * range_m;
}

bool InputOddities::areObjectsInWorld() const {
  return moving_along > kMost && standing < kFew && !isOdometryInMillimetres();  // nothing would be far from it
}

void InputPlausibility::add(const StampedPose& T_odom_base) {
  if (newest_ && T_odom_base.stamp > newest_->stamp) {
    const double way_m = (T_odom_base.T_world_base.translation_m - newest_->T_world_base.translation_m).norm();
    keep(way_m / secondsFromStamp(T_odom_base.stamp - newest_->stamp), speeds_m_per_s_);
  }
  newest_ = T_odom_base;
}

void InputPlausibility::add(const DetectorFrame& frame) {
  if (frame.detections.empty()) return;
  std::deque<double> ranges_m;
  std::deque<double> heights_m;
  for (const Detection& detection : frame.detections) {
    ranges_m.push_back(detection.position_m.head<2>().norm());
    heights_m.push_back(detection.position_m.z());
  }
  keep(medianOf(ranges_m, 1), ranges_m_);
  keep(medianOf(heights_m, 1), heights_m_);
  compare(frame);
}

void InputPlausibility::compare(const DetectorFrame& frame) {
  if (!newest_) return;
  const Pose T_before_now = T_odom_before_.inverse() * newest_->T_world_base;
  const bool is_first = before_m_.empty();
  if (!is_first && T_before_now.translation_m.norm() < kDriven_m) return;
  std::vector<Eigen::Vector3d> now_m;
  std::vector<Eigen::Vector3d> now_from_before_m;
  for (const Detection& detection : frame.detections) {
    now_m.push_back(detection.position_m);
    now_from_before_m.push_back(T_before_now * detection.position_m);
  }
  if (!is_first) keep(shareNear(now_m, before_m_), moving_along_);
  if (!is_first) keep(shareNear(now_from_before_m, before_m_), standing_);
  before_m_ = std::move(now_m);
  T_odom_before_ = newest_->T_world_base;
}

InputOddities InputPlausibility::look() const {
  return {medianOf(speeds_m_per_s_, kEnough), medianOf(ranges_m_, kEnough), medianOf(heights_m_, kEnough),
          medianOf(moving_along_, kEnoughCompared), medianOf(standing_, kEnoughCompared)};
}

}  // namespace semantic_mht_slam
