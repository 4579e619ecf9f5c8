#pragma once

#include <ceres/problem.h>
#include <ceres/version.h>

#if CERES_VERSION_MAJOR > 2 || (CERES_VERSION_MAJOR == 2 && CERES_VERSION_MINOR >= 1)
#include <ceres/manifold.h>
#define SEMANTIC_MHT_SLAM_CERES_MANIFOLD 1
#else
#include <ceres/local_parameterization.h>
#endif

#include "pose_block.h"

namespace semantic_mht_slam {

/// Step of a pose block: R Exp(delta[0..2]), t + delta[3..5].
void addToPose(const double* pose, const double* delta, double* sum);

/// Manifold of pose blocks for cost functions of this module only. They return derivatives by the step itself in the
/// first six columns of their 7-column Jacobians, so the derivative of the step, by which Ceres multiplies them, is
/// [I; 0]. That saves the detour over four quaternion derivatives in every edge and iteration.
#ifdef SEMANTIC_MHT_SLAM_CERES_MANIFOLD
class PoseManifold final : public ceres::Manifold {
 public:
  int AmbientSize() const override { return kPoseBlock; }
  int TangentSize() const override { return 6; }
  bool Plus(const double* pose, const double* delta, double* sum) const override;
  bool PlusJacobian(const double* pose, double* jacobian) const override;
  bool Minus(const double* to, const double* from, double* delta) const override;
  bool MinusJacobian(const double* pose, double* jacobian) const override;
};
inline void setManifold(ceres::Problem& problem, double* block, PoseManifold* manifold) {
  problem.SetManifold(block, manifold);
}
inline void keepManifoldOwnership(ceres::Problem::Options& options) {
  options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
}
#else
class PoseManifold final : public ceres::LocalParameterization {
 public:
  int GlobalSize() const override { return kPoseBlock; }
  int LocalSize() const override { return 6; }
  bool Plus(const double* pose, const double* delta, double* sum) const override;
  bool ComputeJacobian(const double* pose, double* jacobian) const override;
};
inline void setManifold(ceres::Problem& problem, double* block, PoseManifold* manifold) {
  problem.SetParameterization(block, manifold);
}
inline void keepManifoldOwnership(ceres::Problem::Options& options) {
  options.local_parameterization_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
}
#endif

}  // namespace semantic_mht_slam
