#pragma once

#include <optional>

#include <Eigen/Core>

#include "semantic_mht_slam/common/pose.h"

namespace semantic_mht_slam {

/// A rectified camera and where it sits on the sensor whose points it shall see.
struct Camera {
  Eigen::Matrix<double, 3, 4> projection = Eigen::Matrix<double, 3, 4>::Zero();  ///< camera frame to homogeneous pixels
  Pose T_camera_sensor;                                                          ///< camera: x right, y down, z forward

  /// Pixel of a point in the sensor's frame, pixel centres at whole numbers; empty if the point is not in front of the
  /// camera. It may lie outside the image.
  std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& point_m) const {
    const Eigen::Vector3d pixel = projection * (T_camera_sensor * point_m).homogeneous();
    constexpr double kNearest_m = 0.1;
    if (!(pixel.z() > kNearest_m)) return std::nullopt;
    return Eigen::Vector2d(pixel.head<2>() / pixel.z());
  }
};

}  // namespace semantic_mht_slam
