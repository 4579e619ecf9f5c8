#pragma once

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <utility>

#include <nav_msgs/Odometry.h>

#include "semantic_mht_slam/common/stamp.h"

namespace semantic_mht_slam {

/// Keeps one wrong stamp from upsetting the estimator: an odometry message that jumps in time, back or ahead, is held
/// until the next one tells whether time really jumped (it lies near the held one) or the stamp was wrong (it goes on
/// where the others were).
class TimeJumpGuard {
 public:
  /// Falling back by more than `disorder` is a jump back; a step ahead that is larger, and many times larger than the
  /// one before, is one ahead.
  explicit TimeJumpGuard(Stamp disorder) : disorder_(disorder) {}

  /// True for a stamp that falls back: time jumped, or the stamp is wrong.
  bool isBack(Stamp stamp, const std::optional<Stamp>& latest) const { return latest && stamp < *latest - disorder_; }

  /// True for a message that jumps while none is held.
  bool isUnconfirmed(Stamp stamp, const std::optional<Stamp>& latest) const {
    if (held_ || !latest) return false;
    return isBack(stamp, latest) || stamp - *latest > std::max(disorder_, kSteps * step_);
  }

  /// A message is used that comes after `latest`.
  void noteStep(Stamp stamp, const std::optional<Stamp>& latest) {
    if (latest && stamp > *latest) step_ = stamp - *latest;
  }

  void hold(const nav_msgs::Odometry& message) { held_ = message; }
  bool isHolding() const { return held_.has_value(); }

  /// The held message if `stamp` confirms it; either way it is no longer held.
  std::optional<nav_msgs::Odometry> takeConfirmed(Stamp stamp, const std::optional<Stamp>& latest) {
    const std::optional<nav_msgs::Odometry> held = std::exchange(held_, std::nullopt);
    if (!held || !latest) return std::nullopt;
    const Stamp held_stamp = static_cast<Stamp>(held->header.stamp.toNSec());
    const bool is_near_held = std::llabs(stamp - held_stamp) < std::llabs(stamp - *latest);
    return is_near_held ? held : std::nullopt;
  }

 private:
  static constexpr Stamp kSteps = 10;

  Stamp disorder_;
  Stamp step_ = 0;  ///< between the last two messages that were used
  std::optional<nav_msgs::Odometry> held_;
};

}  // namespace semantic_mht_slam
