#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace semantic_mht_slam {

/// Rigid transform of R^3. A value named `T_a_b` maps coordinates in frame b to coordinates in frame a:
/// p_a = T_a_b * p_b. Metres.
///
/// The rotation is stored as a unit quaternion, as ROS messages store it, so that a pose which went through a bag is
/// the same to the last bit as one which came from a file.
struct Pose {
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d translation_m = Eigen::Vector3d::Zero();

  static Pose identity() { return {}; }

  /// From a 3x4 matrix [R | t]; R is projected to the nearest rotation through its quaternion.
  static Pose fromMatrix(const Eigen::Matrix<double, 3, 4>& matrix);

  /// 3x4 matrix [R | t].
  Eigen::Matrix<double, 3, 4> matrix() const;

  Pose inverse() const;
  Pose operator*(const Pose& other) const;
  Eigen::Vector3d operator*(const Eigen::Vector3d& point_m) const { return rotation * point_m + translation_m; }

  /// True if every number is finite and the quaternion has unit norm within 1e-6.
  bool isValid() const;
};

/// Axis-angle vector of a rotation, radians, norm in [0, pi].
Eigen::Vector3d logRotation(const Eigen::Quaterniond& rotation);

/// Rotation of an axis-angle vector in radians; inverse of `logRotation` for norms below pi.
Eigen::Quaterniond expRotation(const Eigen::Vector3d& axis_angle_rad);

/// Matrix of the cross product: skew(v) * w = v x w.
inline Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d matrix;
  matrix << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return matrix;
}

/// Angle between two rotations in radians, in [0, pi].
double angularDistance(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b);

/// Pose between two others: linear in the translation, spherical linear in the rotation.
/// `fraction` 0 gives `from`, 1 gives `to`; values outside [0, 1] throw std::invalid_argument.
Pose interpolate(const Pose& from, const Pose& to, double fraction);

/// A pose with the quaternion scaled to unit norm. Already normalised poses (within 1e-12) are returned bit for bit.
/// A zero or non-finite quaternion throws std::invalid_argument.
Pose normalized(const Pose& pose);

}  // namespace semantic_mht_slam
