#pragma once

#include <cstdlib>
#include <optional>
#include <utility>

#include <nav_msgs/Odometry.h>

#include "semantic_mht_slam/common/stamp.h"

namespace semantic_mht_slam {

/// Keeps one wrong stamp from upsetting the estimator: an odometry message that jumps in time, back or far ahead, is
/// held until the next one tells whether time really jumped (it lies near the held one) or the stamp was wrong (it goes
/// on where the others were).
class TimeJumpGuard {
 public:
  /// Falling back by more than `back` is a jump back.
  explicit TimeJumpGuard(Stamp back) : back_(back) {}

  /// True for a stamp that falls back: time jumped, or the stamp is wrong.
  bool isBack(Stamp stamp, const std::optional<Stamp>& latest) const { return latest && stamp < *latest - back_; }

  /// True for a message that jumps while none is held.
  bool isUnconfirmed(Stamp stamp, const std::optional<Stamp>& latest) const {
    return !held_ && (isBack(stamp, latest) || (latest && stamp > *latest + kAhead));
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
  static constexpr Stamp kAhead = 60LL * 1000000000LL;

  Stamp back_;
  std::optional<nav_msgs::Odometry> held_;
};

}  // namespace semantic_mht_slam
