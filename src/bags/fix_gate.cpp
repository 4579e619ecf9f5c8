#include "semantic_mht_slam/bags/fix_gate.h"

#include "semantic_mht_slam/bags/conversions.h"
#include "semantic_mht_slam/bags/odometry_gate.h"

namespace semantic_mht_slam {
namespace {

/// Empty if tf does not know the frame on the robot.
std::optional<Eigen::Vector3d> antennaOf(const std::string& frame, Stamp stamp, SensorTransforms& sensors) {
  const SensorPlace place = sensors.find(frame, stamp);
  if (place.answer == SensorPlace::Answer::kKnown && !place.is_by_odometry) return place.T_base_sensor.translation_m;
  if (place.answer != SensorPlace::Answer::kMayCome) return std::nullopt;
  const std::optional<Pose> newest = sensors.findNewest(frame);
  return newest ? std::optional(newest->translation_m) : std::nullopt;
}

}  // namespace

std::optional<GnssFix> toFix(const sensor_msgs::NavSatFix& message, SensorTransforms& sensors, const NodeConfig& frames,
                             RefusedInput& refused) {
  if (!isUsableStamp(message.header.stamp)) {
    ++refused.fixes_bad_stamps;
    return std::nullopt;
  }
  GnssFix fix;
  fix.stamp = toStamp(message.header.stamp);
  fix.has_fix = message.status.status != sensor_msgs::NavSatStatus::STATUS_NO_FIX;
  fix.place = {message.latitude, message.longitude, message.altitude};
  if (message.position_covariance_type != sensor_msgs::NavSatFix::COVARIANCE_TYPE_UNKNOWN) {
    fix.cov_m2 = Eigen::Map<const Eigen::Matrix3d>(message.position_covariance.data());
  }
  const std::string frame = withoutSlash(message.header.frame_id);
  if (frame.empty() || frame == frames.base_frame) return fix;
  fix.antenna_m = antennaOf(frame, fix.stamp, sensors);
  if (!fix.antenna_m && fix.has_fix) {
    ++refused.fixes_without_transform;
    refused.antenna_frame = frame;
  }
  return fix;
}

}  // namespace semantic_mht_slam
