#include "semantic_mht_slam/bags/odometry_gate.h"

#include <cstdint>

#include "semantic_mht_slam/bags/conversions.h"
#include "semantic_mht_slam/bags/sensor_transforms.h"

namespace semantic_mht_slam {
namespace {

constexpr std::uint32_t kLastUsable_s = 4294967295U - 3600U;

}  // namespace

bool isUsableStamp(const ros::Time& stamp) {
  return !stamp.isZero() && stamp.sec <= kLastUsable_s;
}

bool OdometryGate::isUsable(const nav_msgs::Odometry& message, RefusedInput& refused) const {
  if (withoutSlash(message.header.frame_id) != odom_frame_ || withoutSlash(message.child_frame_id) != base_frame_) {
    ++refused.odometry_wrong_frames;
    refused.wrong_frames = "'" + message.header.frame_id + "' to '" + message.child_frame_id + "'";
    return false;
  }
  if (!isUsableStamp(message.header.stamp)) {
    ++refused.odometry_bad_stamps;
    return false;
  }
  return true;
}

std::vector<nav_msgs::Odometry> OdometryGate::pass(const nav_msgs::Odometry& message,
                                                   const std::optional<Stamp>& latest, RefusedInput& refused) {
  const Stamp stamp = toStamp(message.header.stamp);
  if (jump_.isUnconfirmed(stamp, latest)) {
    jump_.hold(message);
    return {};
  }
  const bool was_holding = jump_.isHolding();
  if (const auto jumped = jump_.takeConfirmed(stamp, latest)) {
    jump_.noteStep(stamp, toStamp(jumped->header.stamp));
    return {*jumped, message};
  }
  jump_.noteStep(stamp, latest);
  refused.odometry_stamp_outliers += was_holding ? 1 : 0;
  return {message};
}

void OdometryGate::giveUpHeld(RefusedInput& refused) {
  if (!jump_.isHolding()) return;
  jump_.takeConfirmed(0, std::nullopt);
  ++refused.odometry_stamp_outliers;
}

}  // namespace semantic_mht_slam
