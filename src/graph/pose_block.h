#pragma once

#include <algorithm>

#include "semantic_mht_slam/common/pose.h"
#include "semantic_mht_slam/graph/pose2.h"

#include "edge_residuals.h"

namespace semantic_mht_slam {

/// Numbers of a pose in space as the residuals take it: quaternion x y z w, translation x y z.
constexpr int kPoseBlock = 7;
/// Numbers of a planar pose: x, y, heading.
constexpr int kPose2Block = 3;

inline void writeBlock(const Pose2& pose, double* block) {
  block[0] = pose.translation_m.x();
  block[1] = pose.translation_m.y();
  block[2] = pose.heading_rad;
}

inline void writeBlock(const Pose& pose, double* block) {
  std::copy_n(pose.rotation.coeffs().data(), 4, block);
  std::copy_n(pose.translation_m.data(), 3, block + 4);
}

inline void readBlock(const double* block, Pose2& pose) {
  pose.translation_m << block[0], block[1];
  pose.heading_rad = wrappedAngle(block[2]);
}

inline void readBlock(const double* block, Pose& pose) {
  std::copy_n(block, 4, pose.rotation.coeffs().data());
  std::copy_n(block + 4, 3, pose.translation_m.data());
}

/// Error of a relative pose measurement (see `BatchGraph`) at two estimates.
inline Eigen::Vector3d edgeError(const Pose2& from, const Pose2& to, const Pose2& measured) {
  double a[kPose2Block];
  double b[kPose2Block];
  writeBlock(from, a);
  writeBlock(to, b);
  return relativeError(a, b, measured).error;
}

inline Vector6d edgeError(const Pose& from, const Pose& to, const Pose& measured) {
  double a[kPoseBlock];
  double b[kPoseBlock];
  writeBlock(from, a);
  writeBlock(to, b);
  return relativeError(a, b, measured.rotation, measured.translation_m).error;
}

}  // namespace semantic_mht_slam
