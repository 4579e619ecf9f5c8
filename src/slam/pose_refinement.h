#pragma once

#include <vector>

#include "semantic_mht_slam/common/pose.h"
#include "semantic_mht_slam/graph/pose_graph.h"

namespace semantic_mht_slam {

/// The same object as two sides have it.
struct PointPair {
  Eigen::Vector3d in_b_m;  ///< position in frame b
  Eigen::Vector3d in_a_m;  ///< position in frame a
  Eigen::Matrix3d cov_m2;  ///< of the difference, axes of a
};

/// A relative pose with the covariance of a step on its right.
struct RefinedPose {
  Pose T_a_b;
  PoseCov cov;
};

/// Least squares over all six degrees of freedom from a first guess whose roll and pitch (axes of b) are known to
/// `tilt_stddev_rad`, with Huber weights beyond `huber_sigma` deviations. The covariance is that of the normal
/// equations and never below what the noise floor `floor_m2`, common to all pairs, leaves.
RefinedPose refinePose(const Pose& T_a_b, const std::vector<PointPair>& pairs, double tilt_stddev_rad,
                       double huber_sigma, double floor_m2);

}  // namespace semantic_mht_slam
