#include "semantic_mht_slam/slam/localizer.h"

#include <algorithm>

#include "semantic_mht_slam/place/scene_accumulation.h"

namespace semantic_mht_slam {
namespace {

constexpr std::size_t kMinObjects = 6;

}  // namespace

void describe(LocalizerConfig& config, Fields& fields) {
  fields.add("window", config.window_m, "m", {1.0, 200.0},
             "What was seen over this distance is compared with the map.");
  fields.add("step", config.step_m, "m", {0.5, 100.0}, "Distance between two comparisons.");
  fields.add("agree_distance", config.agree_m, "m", {0.1, 100.0}, "Two finds agree if they differ by no more,");
  fields.add("agree_angle", config.agree_rad, "rad", {0.001, 3.0}, "and in heading by no more.");
  fields.add("min_apart", config.min_apart_m, "m", {0.0, 1000.0},
             "Two finds that confirm each other are so far apart,");
  fields.add("max_apart", config.max_apart_m, "m", {1.0, 1000.0}, "and no further.");
  fields.add("lost_after", config.lost_after_m, "m", {1.0, 10000.0}, "Lost after this distance without a fix.");
  fields.add("merge_radius", config.merge_radius_m, "m", {0.001, 100.0},
             "Detections of the window are of one object if they stand no further apart, or as near as their noise.");
  fields.add("known_passes", config.known_passes, "", {0, 1000},
             "A place that was mapped so many times is known: while there, the vehicle localizes, and the map does not "
             "grow; 0: never.");
}

void Localizer::expectAt(const Pose& T_map_odom, double stddev_m) {
  is_located_ = true;
  T_map_odom_ = T_map_odom;
  fixed_ = driven_;
  told_stddev_m_ = stddev_m;
}

bool Localizer::add(const Frame& frame, const Map& map, const LoopCloser& closer) {
  if (!window_.empty()) {
    driven_ = driven_ + motionOf(window_.back().T_odom_base.inverse() * frame.T_odom_base);
  }
  window_.push_back(frame);
  window_driven_.push_back(driven_);
  while (driven_.way_m - window_driven_.front().way_m > config_.window_m) {
    window_.pop_front();
    window_driven_.pop_front();
  }
  if (driven_.way_m - attempted_m_ < config_.step_m) return false;
  attempted_m_ = driven_.way_m;
  if (is_located_ && (driven_ - fixed_).way_m > config_.lost_after_m) is_located_ = false;
  const Scene seen = scene(closer);
  if (seen.objects.size() < kMinObjects) return false;
  return is_located_ ? track(seen, map, closer) : search(seen, map, closer);
}

Scene Localizer::scene(const LoopCloser& closer) const {
  std::vector<SeenFrame> frames;
  const OdometryModel& odometry = closer.odometry();
  const Pose T_base_odom = window_.back().T_odom_base.inverse();
  for (std::size_t i = 0; i < window_.size(); ++i) {
    frames.push_back({window_[i].detections, expectedStep(odometry, T_base_odom * window_[i].T_odom_base),
                      varianceOf(odometry, driven_ - window_driven_[i])});
  }
  return accumulateScene(frames, closer.classes(), config_.merge_radius_m);
}

bool Localizer::agree(const Find& a, const Find& b) const {
  const double apart_m = b.driven_m - a.driven_m;
  if (apart_m < config_.min_apart_m || apart_m > config_.max_apart_m) return false;
  const Pose& T_odom_base = window_.back().T_odom_base;
  const Pose by_a = a.T_map_odom * T_odom_base;
  const Pose by_b = b.T_map_odom * T_odom_base;
  return (by_a.translation_m - by_b.translation_m).head<2>().norm() < config_.agree_m &&
         angularDistance(by_a.rotation, by_b.rotation) < config_.agree_rad;
}

bool Localizer::search(const Scene& seen, const Map& map, const LoopCloser& closer) {
  const std::optional<FoundPlace> found = closer.locate(map, seen);
  if (!found) return false;
  const Pose T_map_base = map.T_map_keyframe(found->match) * found->T_match_base;
  const Find find{driven_.way_m, T_map_base * window_.back().T_odom_base.inverse()};
  const bool is_confirmed =
      std::any_of(finds_.begin(), finds_.end(), [&](const Find& earlier) { return agree(earlier, find); });
  finds_.push_back(find);
  while (driven_.way_m - finds_.front().driven_m > config_.max_apart_m) finds_.pop_front();
  if (!is_confirmed) return false;
  finds_.clear();
  is_located_ = true;
  settle(*found, map);
  return true;
}

bool Localizer::track(const Scene& seen, const Map& map, const LoopCloser& closer) {
  const Pose T_map_base = *T_map_odom_ * window_.back().T_odom_base;
  const std::optional<FoundPlace> found = closer.findNear(map, seen, T_map_base, told_stddev_m_, driven_ - fixed_);
  if (!found) return false;
  settle(*found, map);
  return true;
}

void Localizer::settle(const FoundPlace& found, const Map& map) {
  const Frame& newest = window_.back();
  const Pose T_map_base = map.T_map_keyframe(found.match) * found.T_match_base;
  T_map_odom_ = T_map_base * newest.T_odom_base.inverse();
  found_by_ = found.match;
  fixed_ = driven_;
  told_stddev_m_ = 0.0;
  fix_ =
      MapFix{newest.stamp, newest.T_odom_base, *T_map_odom_ * newest.T_odom_base, inFixedAxes(T_map_base, found.cov)};
}

}  // namespace semantic_mht_slam
