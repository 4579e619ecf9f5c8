#pragma once

#include <Eigen/Core>

#include "semantic_mht_slam/common/pose.h"
#include "semantic_mht_slam/graph/pose2.h"

#include "edge_residuals.h"

namespace semantic_mht_slam {

/// Adjoint of a transform for steps ordered translation, rotation: T Exp(x) = Exp(adjoint(T) x) T.
inline Eigen::Matrix3d adjoint(const Pose2& pose) {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Identity();
  matrix.topLeftCorner<2, 2>() = pose.rotationMatrix();
  matrix(0, 2) = pose.translation_m.y();
  matrix(1, 2) = -pose.translation_m.x();
  return matrix;
}

inline Matrix6d adjoint(const Pose& pose) {
  const Eigen::Matrix3d rotation = pose.rotation.toRotationMatrix();
  Matrix6d matrix;
  matrix << rotation, skew(pose.translation_m) * rotation, Eigen::Matrix3d::Zero(), rotation;
  return matrix;
}

/// How far a transform is from the identity, to first order: translation, rotation angle(s).
inline Eigen::Vector3d offset(const Pose2& pose) {
  return {pose.translation_m.x(), pose.translation_m.y(), wrappedAngle(pose.heading_rad)};
}

inline Vector6d offset(const Pose& pose) {
  Vector6d vector;
  vector << pose.translation_m, logRotation(pose.rotation);
  return vector;
}

}  // namespace semantic_mht_slam
