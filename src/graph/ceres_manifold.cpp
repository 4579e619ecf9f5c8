#include "ceres_manifold.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace semantic_mht_slam {
namespace {

bool identityOnTop(double* jacobian) {
  std::fill_n(jacobian, kPoseBlock * 6, 0.0);
  for (int i = 0; i < 6; ++i) jacobian[i * 6 + i] = 1.0;
  return true;
}

}  // namespace

void addToPose(const double* pose, const double* delta, double* sum) {
  const Eigen::Map<const Eigen::Quaterniond> rotation(pose);
  const Eigen::Quaterniond step = expRotation(Eigen::Map<const Eigen::Vector3d>(delta));
  Eigen::Map<Eigen::Quaterniond> turned(sum);
  turned = (rotation * step).normalized();
  for (int i = 0; i < 3; ++i) sum[4 + i] = pose[4 + i] + delta[3 + i];
}

bool PoseManifold::Plus(const double* pose, const double* delta, double* sum) const {
  addToPose(pose, delta, sum);
  return true;
}

#ifdef SEMANTIC_MHT_SLAM_CERES_MANIFOLD
bool PoseManifold::PlusJacobian(const double* /*pose*/, double* jacobian) const {
  return identityOnTop(jacobian);
}

bool PoseManifold::Minus(const double* to, const double* from, double* delta) const {
  const Eigen::Map<const Eigen::Quaterniond> rotation_to(to);
  const Eigen::Map<const Eigen::Quaterniond> rotation_from(from);
  Eigen::Map<Eigen::Vector3d> turn(delta);
  turn = logRotation(rotation_from.conjugate() * rotation_to);
  for (int i = 0; i < 3; ++i) delta[3 + i] = to[4 + i] - from[4 + i];
  return true;
}

bool PoseManifold::MinusJacobian(const double* /*pose*/, double* jacobian) const {
  std::fill_n(jacobian, kPoseBlock * 6, 0.0);
  for (int i = 0; i < 6; ++i) jacobian[i * kPoseBlock + i] = 1.0;
  return true;
}
#else
bool PoseManifold::ComputeJacobian(const double* /*pose*/, double* jacobian) const {
  return identityOnTop(jacobian);
}
#endif

}  // namespace semantic_mht_slam
