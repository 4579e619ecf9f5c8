#pragma once

#include <optional>

#include "semantic_mht_slam/app/live_config.h"
#include "semantic_mht_slam/common/pose.h"
#include "semantic_mht_slam/common/stamp.h"

namespace semantic_mht_slam {

/// The correction `T_map_odom` as it is published: the estimate itself, or one that follows it so slowly that the robot
/// never moves in the map faster than a limit because of it. The limit holds where the robot is: a turn of the odometry
/// frame, seen from far away, would otherwise be a jump.
class CorrectionFollower {
 public:
  /// The correction to publish for `stamp`, at which the odometry says `T_odom_base`. The first one and the first after
  /// `reset` equal the estimate; a stamp that does not rise moves nothing.
  Pose follow(const Pose& T_map_odom, const Pose& T_odom_base, Stamp stamp, const LiveConfig& config);

  /// What was published last; identity before the first.
  const Pose& published() const { return published_; }

  /// The next correction is published as it is: a new map has begun.
  void reset() { stamp_.reset(); }

 private:
  Pose published_;
  std::optional<Stamp> stamp_;
};

/// The pose on the way from `from` to `to` after moving at most `distance_m` and turning at most `angle_rad`; `to`
/// itself, to the bit, if both allow it.
Pose limitedStep(const Pose& from, const Pose& to, double distance_m, double angle_rad);

}  // namespace semantic_mht_slam
