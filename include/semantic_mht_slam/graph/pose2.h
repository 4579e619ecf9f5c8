#pragma once

#include <Eigen/Core>

namespace semantic_mht_slam {

/// Rigid transform of the plane. A value named `T_a_b` maps coordinates in frame b to coordinates in frame a.
/// Only pose-graph files need it: everything else in this package moves in space (`Pose`).
struct Pose2 {
  Eigen::Vector2d translation_m = Eigen::Vector2d::Zero();
  double heading_rad = 0.0;  ///< any real number; only its sine and cosine count

  Pose2 inverse() const;
  Pose2 operator*(const Pose2& other) const;
  Eigen::Vector2d operator*(const Eigen::Vector2d& point_m) const;

  /// 2x2 rotation matrix of the heading.
  Eigen::Matrix2d rotationMatrix() const;

  /// True if every number is finite.
  bool isValid() const;
};

/// The same angle in [-pi, pi].
double wrappedAngle(double angle_rad);

}  // namespace semantic_mht_slam
