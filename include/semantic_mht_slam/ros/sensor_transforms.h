#pragma once

#include <map>
#include <optional>
#include <string>

#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include "semantic_mht_slam/common/pose.h"

namespace semantic_mht_slam {

/// A frame name as tf2 takes it: older packages write a slash before it.
std::string withoutSlash(const std::string& frame);

/// Where the sensors are on the robot. They are fixed to it, so one look-up is enough.
class SensorTransforms {
 public:
  explicit SensorTransforms(const std::string& base_frame) : base_frame_(base_frame), listener_(transforms_) {}

  /// T_base_sensor; empty while tf does not connect the two.
  std::optional<Pose> find(const std::string& frame);

 private:
  const std::string base_frame_;
  tf2_ros::Buffer transforms_;
  tf2_ros::TransformListener listener_;
  std::map<std::string, Pose> T_base_sensor_;
};

}  // namespace semantic_mht_slam
