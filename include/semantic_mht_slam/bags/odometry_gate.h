#pragma once

#include <optional>
#include <vector>

#include <nav_msgs/Odometry.h>

#include "semantic_mht_slam/app/refused_input.h"
#include "semantic_mht_slam/app/system_config.h"
#include "semantic_mht_slam/bags/time_jump_guard.h"
#include "semantic_mht_slam/common/stamp.h"

namespace semantic_mht_slam {

/// True for a stamp that one can compute with: not zero, and not in the last hour of ROS's time (2106), after which
/// stamps that follow from it cannot be written.
bool isUsableStamp(const ros::Time& stamp);

/// The way of odometry messages to the estimator, for the node and for bags alike: their frames, their stamps, and
/// jumps in time, which one message alone does not make. What is refused is counted.
class OdometryGate {
 public:
  explicit OdometryGate(const NodeConfig& config)
      : odom_frame_(config.odom_frame),
        base_frame_(config.base_frame),
        jump_(stampFromSeconds(config.reset_after_jump_back_s)) {}

  /// Whether frames and stamp of a message can be used.
  bool isUsable(const nav_msgs::Odometry& message, RefusedInput& refused) const;

  /// What is to be used now that a usable message has come, in its order: nothing while the message is held because it
  /// jumps, two messages if it confirms the jump of the one before. `latest` is the newest stamp in use; a first
  /// message before it means that time fell back.
  std::vector<nav_msgs::Odometry> pass(const nav_msgs::Odometry& message, const std::optional<Stamp>& latest,
                                       RefusedInput& refused);

  /// No message comes any more that could confirm the one that is held.
  void giveUpHeld(RefusedInput& refused);

  /// True while a message that jumps waits for the next one.
  bool isHolding() const { return jump_.isHolding(); }

  /// True for a stamp that falls back behind another one by more than disorder.
  bool isBack(Stamp stamp, const std::optional<Stamp>& latest) const { return jump_.isBack(stamp, latest); }

 private:
  const std::string odom_frame_;
  const std::string base_frame_;
  TimeJumpGuard jump_;
};

}  // namespace semantic_mht_slam
