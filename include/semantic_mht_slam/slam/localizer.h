#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "semantic_mht_slam/common/config.h"
#include "semantic_mht_slam/models/frame.h"
#include "semantic_mht_slam/slam/loop_closer.h"
#include "semantic_mht_slam/slam/map_fix.h"

namespace semantic_mht_slam {

/// How a vehicle finds and keeps its pose in a finished map.
struct LocalizerConfig {
  Length window_m{20.0};
  Length step_m{4.0};
  Length agree_m{2.0};
  double agree_rad = 0.06;
  Length min_apart_m{8.0};
  Length max_apart_m{40.0};
  Length lost_after_m{100.0};
  Length merge_radius_m{0.8};
  int known_passes = 8;
};

void describe(LocalizerConfig& config, Fields& fields);

/// Finds the vehicle in a finished map and follows it, without changing the map. While it is lost, what was seen over
/// the last metres is looked for among all keyframes by its objects alone (`LoopCloser::locate`); the pose is believed
/// once two finds, some metres apart, agree. From then on the same scene is laid onto the map near the expected pose
/// (`findInMap`). Without success for `lost_after_m` it is lost again.
class Localizer {
 public:
  explicit Localizer(const LocalizerConfig& config) : config_(config) {}

  /// Where the vehicle is believed to be, from outside: tracking begins there, with `stddev_m` as its uncertainty.
  void expectAt(const Pose& T_map_odom, double stddev_m);

  /// The next frame, with calibrated detections (`Mapper::calibrated`). True if it led to a fix.
  bool add(const Frame& frame, const Map& map, const LoopCloser& closer);

  bool isLocated() const { return is_located_; }

  /// Correction of the odometry; empty before the first fix.
  const std::optional<Pose>& T_map_odom() const { return T_map_odom_; }

  /// Driven since the newest fix, or since the pose was told.
  double sinceFix_m() const { return (driven_ - fixed_).way_m; }

  /// The newest fix, its covariance being that of what was found, as if the map were exact there; only after one.
  const MapFix& fix() const { return *fix_; }

  /// The keyframe that it was found by.
  KeyframeId foundBy() const { return found_by_; }

 private:
  struct Find {
    double driven_m = 0.0;
    Pose T_map_odom;
  };

  Scene scene(const LoopCloser& closer) const;
  bool search(const Scene& scene, const Map& map, const LoopCloser& closer);
  bool track(const Scene& scene, const Map& map, const LoopCloser& closer);
  bool agree(const Find& a, const Find& b) const;
  void settle(const FoundPlace& found, const Map& map);

  LocalizerConfig config_;
  std::deque<Frame> window_;
  std::deque<Motion> window_driven_;
  Motion driven_;
  double attempted_m_ = 0.0;
  Motion fixed_;                ///< driven at the last fix
  double told_stddev_m_ = 0.0;  ///< uncertainty of a pose that was told, until there is a fix
  std::deque<Find> finds_;
  bool is_located_ = false;
  std::optional<Pose> T_map_odom_;
  std::optional<MapFix> fix_;
  KeyframeId found_by_;
};

}  // namespace semantic_mht_slam
