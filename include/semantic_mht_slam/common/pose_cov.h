#pragma once

#include <Eigen/Core>

#include "semantic_mht_slam/common/pose.h"

namespace semantic_mht_slam {

/// Covariance of the error of a relative pose T_from_to: order translation (m), rotation (rad), both in the frame `to`,
/// the error being a small step on the right of the measurement.
using PoseCov = Eigen::Matrix<double, 6, 6>;

/// What errors that all steps of an odometry have alike (its scale, a bend) do to a pose, a column for a standard
/// deviation of each: true pose less the one that is believed; rows as the holder's covariance has them.
constexpr int kSharedErrors = 5;
using SharedErrors = Eigen::Matrix<double, 6, kSharedErrors>;

/// Covariance of the error of a pose T_a_b as ROS has it (geometry_msgs/PoseWithCovariance): order position (m),
/// rotation (rad), both about the fixed axes of a, the position being that of the origin of b.
using FixedAxesCov = Eigen::Matrix<double, 6, 6>;

FixedAxesCov inFixedAxes(const Pose& T_a_b, const PoseCov& cov);
SharedErrors inFixedAxes(const Pose& T_a_b, const SharedErrors& errors);

/// What the error of a pose (fixed axes of a) is at a place that hangs on it rigidly, `lever_m` from its origin, axes
/// of a: an error of the rotation swings it.
Eigen::Matrix<double, 6, 6> swing(const Eigen::Vector3d& lever_m);
FixedAxesCov carried(const FixedAxesCov& cov, const Eigen::Vector3d& lever_m);

/// Covariance of a pose of which nothing is known: variances so large that no filter uses it, but positive ones.
FixedAxesCov unknownPoseCov();

}  // namespace semantic_mht_slam
