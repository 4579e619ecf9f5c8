#pragma once

#include "semantic_mht_slam/common/pose_cov.h"
#include "semantic_mht_slam/models/odometry_model.h"

namespace semantic_mht_slam {

/// What is not known of the systematic errors, of one standard deviation each, does to a step T_a_b; order and axes as
/// in `stepCovariance`, columns in the order of `SystematicErrors`.
SharedErrors sharedErrorsOf(const SystematicErrors& errors, const Pose& T_a_b);

/// A pose in the world that is not known exactly.
struct UncertainPose {
  Pose T_world_base;
  FixedAxesCov cov = FixedAxesCov::Zero();     ///< fixed axes of the world, without what comes from shared errors
  SharedErrors shared = SharedErrors::Zero();  ///< the same axes

  FixedAxesCov total() const { return cov + shared * shared.transpose(); }
};

/// The pose after a step T_base_next of the odometry: its noise is added, an error of the rotation swings the step, and
/// what it errs systematically, which is not taken off the step, acts on each one alike.
UncertainPose reckoned(const UncertainPose& pose, const Pose& T_base_next, const OdometryModel& odometry);

}  // namespace semantic_mht_slam
