#include "semantic_mht_slam/ros/sensor_transforms.h"

#include "semantic_mht_slam/ros/conversions.h"

namespace semantic_mht_slam {

std::string withoutSlash(const std::string& frame) {
  return !frame.empty() && frame.front() == '/' ? frame.substr(1) : frame;
}

std::optional<Pose> SensorTransforms::find(const std::string& frame) {
  const std::string sensor_frame = withoutSlash(frame);
  const auto known = T_base_sensor_.find(sensor_frame);
  if (known != T_base_sensor_.end()) return known->second;
  if (!transforms_.canTransform(base_frame_, sensor_frame, ros::Time(0))) return std::nullopt;
  const auto transform = transforms_.lookupTransform(base_frame_, sensor_frame, ros::Time(0));
  return T_base_sensor_.emplace(sensor_frame, fromMessage(transform.transform)).first->second;
}

}  // namespace semantic_mht_slam
