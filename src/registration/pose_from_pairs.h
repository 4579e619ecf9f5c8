#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "semantic_mht_slam/common/pose.h"

namespace semantic_mht_slam {

/// The same object as two sides have it.
struct PointPair {
  Eigen::Vector3d in_a_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d in_b_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d cov_m2 = Eigen::Matrix3d::Identity();    ///< of the difference, axes of a
  Eigen::Matrix3d a_cov_m2 = Eigen::Matrix3d::Identity();  ///< the part of the side a
  double weight = 1.0;                                     ///< in [0, 1]
};

/// A relative pose. Covariance: order translation (m), rotation (rad), both in frame b, a small step on the right.
struct PoseEstimate {
  Pose T_a_b;
  Eigen::Matrix<double, 6, 6> cov = Eigen::Matrix<double, 6, 6>::Identity();
};

/// Least squares over all six degrees of freedom from a first guess whose roll and pitch (axes of b) are known to
/// `tilt_stddev_rad`, with Huber weights beyond two standard deviations. The covariance is that of the normal
/// equations and, as the points of a may all err alike (those of one map do), the covariance that a mean over them
/// keeps then, however many they are. Empty if the pairs leave the pose open.
[[nodiscard]] std::optional<PoseEstimate> poseFromPairs(const Pose& T_a_b, const std::vector<PointPair>& pairs,
                                                        double tilt_stddev_rad);

}  // namespace semantic_mht_slam
