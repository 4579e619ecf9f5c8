#pragma once

#include <cmath>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "semantic_mht_slam/common/pose.h"
#include "semantic_mht_slam/graph/pose2.h"

namespace semantic_mht_slam {

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

/// Error of a relative pose and its derivatives by steps of both poses, before whitening. Definition: `BatchGraph`.
/// Steps of a planar pose add to x, y, heading; those of a spatial one are R Exp(delta[0..2]), t + delta[3..5].
template <class Vector, class Matrix>
struct RelativeError {
  Vector error;
  Matrix by_from;
  Matrix by_to;
};

inline RelativeError<Eigen::Vector3d, Eigen::Matrix3d> relativeError(const double* from, const double* to,
                                                                     const Pose2& measured) {
  const double heading = from[2] + measured.heading_rad;
  const double c = std::cos(heading);
  const double s = std::sin(heading);
  const double dx = to[0] - from[0];
  const double dy = to[1] - from[1];
  const double cm = std::cos(measured.heading_rad);
  const double sm = std::sin(measured.heading_rad);
  const Eigen::Vector2d& t = measured.translation_m;
  const double x = c * dx + s * dy;
  const double y = -s * dx + c * dy;
  RelativeError<Eigen::Vector3d, Eigen::Matrix3d> result;
  result.error << x - (cm * t.x() + sm * t.y()), y - (-sm * t.x() + cm * t.y()), wrappedAngle(to[2] - heading);
  result.by_to << c, s, 0.0, -s, c, 0.0, 0.0, 0.0, 1.0;
  result.by_from << -c, -s, y, s, -c, -x, 0.0, 0.0, -1.0;
  return result;
}

inline RelativeError<Vector6d, Matrix6d> relativeError(const double* from, const double* to,
                                                       const Eigen::Quaterniond& q_from_to,
                                                       const Eigen::Vector3d& t_from_to) {
  const Eigen::Map<const Eigen::Quaterniond> q_from(from);
  const Eigen::Map<const Eigen::Quaterniond> q_to(to);
  const Eigen::Map<const Eigen::Vector3d> t_from(from + 4);
  const Eigen::Map<const Eigen::Vector3d> t_to(to + 4);
  const Eigen::Matrix3d turn_back = q_from_to.conjugate().toRotationMatrix();
  const Eigen::Matrix3d world_to_from = q_from.conjugate().toRotationMatrix();
  const Eigen::Vector3d seen = world_to_from * (t_to - t_from);
  Eigen::Quaterniond q_error = q_from_to.conjugate() * (q_from.conjugate() * q_to);
  if (q_error.w() < 0.0) q_error.coeffs() *= -1.0;
  const Eigen::Matrix3d cross = skew(q_error.vec());
  const Eigen::Matrix3d scalar = q_error.w() * Eigen::Matrix3d::Identity();

  RelativeError<Vector6d, Matrix6d> result;
  result.error << turn_back * (seen - t_from_to), 2.0 * q_error.vec();
  const Eigen::Matrix3d by_translation = turn_back * world_to_from;
  result.by_to << Eigen::Matrix3d::Zero(), by_translation, scalar + cross, Eigen::Matrix3d::Zero();
  result.by_from << turn_back * skew(seen), -by_translation, (cross - scalar) * turn_back, Eigen::Matrix3d::Zero();
  return result;
}

/// Error R^T (p - t) - p_measured of a point seen from a pose, and its derivatives.
template <int kDim, int kDof>
struct PointError {
  Eigen::Matrix<double, kDim, 1> error;
  Eigen::Matrix<double, kDim, kDof> by_pose;
  Eigen::Matrix<double, kDim, kDim> by_point;
};

inline PointError<2, 3> pointError(const double* pose, const double* point, const Eigen::Vector2d& measured_m) {
  const double c = std::cos(pose[2]);
  const double s = std::sin(pose[2]);
  const double dx = point[0] - pose[0];
  const double dy = point[1] - pose[1];
  const double x = c * dx + s * dy;
  const double y = -s * dx + c * dy;
  PointError<2, 3> result;
  result.error << x - measured_m.x(), y - measured_m.y();
  result.by_point << c, s, -s, c;
  result.by_pose << -c, -s, y, s, -c, -x;
  return result;
}

inline PointError<3, 6> pointError(const double* pose, const double* point, const Eigen::Vector3d& measured_m) {
  const Eigen::Matrix3d world_to_pose = Eigen::Map<const Eigen::Quaterniond>(pose).conjugate().toRotationMatrix();
  const Eigen::Vector3d seen =
      world_to_pose * (Eigen::Map<const Eigen::Vector3d>(point) - Eigen::Map<const Eigen::Vector3d>(pose + 4));
  PointError<3, 6> result;
  result.error = seen - measured_m;
  result.by_point = world_to_pose;
  result.by_pose << skew(seen), -world_to_pose;
  return result;
}

}  // namespace semantic_mht_slam
