#pragma once

#include <vector>

#include "semantic_mht_slam/common/gaussian.h"
#include "semantic_mht_slam/common/pose.h"
#include "semantic_mht_slam/models/odometry_model.h"

namespace semantic_mht_slam {

/// Error of the odometry's pose in the submap, as a hypothesis sees it: translation (submap axes) and heading about the
/// sensor. T_submap_base (corrected) = translation + rotation about z, applied at the odometry's position.
struct PoseOffset {
  Eigen::Vector4d mean = Eigen::Vector4d::Zero();  ///< x, y, z in m, yaw in rad
  Eigen::Matrix4d cov = Eigen::Matrix4d::Zero();   ///< m^2, m rad, rad^2
};

/// The corrected pose of the base in the submap.
Pose corrected(const Pose& T_submap_base, const PoseOffset& offset);

/// Covariance of the corrected pose of an offset from the identity, as a small step on its right: order translation
/// (m), rotation (rad), axes of the base. Roll and pitch, of which an offset says nothing, are known to
/// `tilt_stddev_rad`.
Eigen::Matrix<double, 6, 6> stepCov(const PoseOffset& offset, double tilt_stddev_rad);

/// Covariance that the offset's uncertainty gives to a point seen at `lever_m` from the base (submap axes), m^2.
Eigen::Matrix3d pointCov(const PoseOffset& offset, const Eigen::Vector3d& lever_m);

/// The offset after a step of the odometry, whose poses are in the submap: an error of the heading turns the step, the
/// odometry's scale errors are taken off, its noise is added.
PoseOffset grown(const PoseOffset& offset, const Pose& T_submap_last, const Pose& T_submap_base,
                 const OdometryModel& odometry);

/// A detection and the landmark that it was assigned to.
struct OffsetObservation {
  Eigen::Vector3d lever_m;     ///< detection from the base, submap axes, with the offset's mean applied
  Eigen::Vector3d residual_m;  ///< landmark minus detection
  Eigen::Matrix3d cov_m2;      ///< of the residual, without the offset's part
};

constexpr double kOffsetHuberSigma = 2.0;  ///< of hypotheses' offsets, in the submap and in the earlier map

/// Kalman update of the offset by all assigned detections of a frame, with Huber weights beyond `huber_sigma`
/// deviations. Without observations, or if the result is not finite, the offset stays as it was.
PoseOffset updated(const PoseOffset& offset, const std::vector<OffsetObservation>& observations, double huber_sigma);

}  // namespace semantic_mht_slam
