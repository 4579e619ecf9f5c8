#pragma once

#include <string>

#include "semantic_mht_slam/common/pose.h"

namespace semantic_mht_slam {

/// How an odometry's frames are turned; both its world and its body have the same axes.
enum class OdometryAxes {
  kRos,      ///< x forward, y left, z up (REP-103)
  kLoam,     ///< x left, y up, z forward: LOAM, LeGO-LOAM
  kOptical,  ///< x right, y down, z forward: a camera's
};

/// "ros", "loam" or "optical". Throws InputError for anything else.
OdometryAxes odometryAxesOf(const std::string& name);

/// The same motion as seen in ROS axes.
Pose toRosAxes(const Pose& T_world_body, OdometryAxes axes);

}  // namespace semantic_mht_slam
