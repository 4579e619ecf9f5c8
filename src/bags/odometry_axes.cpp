#include "semantic_mht_slam/bags/odometry_axes.h"

#include "semantic_mht_slam/common/error.h"

namespace semantic_mht_slam {

OdometryAxes odometryAxesOf(const std::string& name) {
  if (name == "ros") return OdometryAxes::kRos;
  if (name == "loam") return OdometryAxes::kLoam;
  if (name == "optical") return OdometryAxes::kOptical;
  throw InputError("axes '" + name + "' are unknown; there are ros, loam and optical");
}

Pose toRosAxes(const Pose& T_world_body, OdometryAxes axes) {
  if (axes == OdometryAxes::kRos) return T_world_body;
  // A third of a turn about (1, 1, 1) and (1, -1, 1): forward z becomes x.
  const Eigen::Quaterniond loam(0.5, 0.5, 0.5, 0.5);
  const Eigen::Quaterniond optical(0.5, -0.5, 0.5, -0.5);
  const Eigen::Quaterniond& R_ros_axes = axes == OdometryAxes::kLoam ? loam : optical;
  return {R_ros_axes * T_world_body.rotation * R_ros_axes.conjugate(), R_ros_axes * T_world_body.translation_m};
}

}  // namespace semantic_mht_slam
