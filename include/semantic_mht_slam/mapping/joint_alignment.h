#pragma once

#include <vector>

#include <Eigen/Core>

#include "semantic_mht_slam/common/config.h"
#include "semantic_mht_slam/common/pose.h"
#include "semantic_mht_slam/models/class_table.h"

namespace semantic_mht_slam {

/// A classified point with uncertainty: a detection in its own frame b, or a landmark in the frame a of a map.
struct AlignmentPoint {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d cov_m2 = Eigen::Matrix3d::Identity();
  ClassIndex class_index = 0;
};

/// Where frame b is believed to be in the map, and how far it may have drifted: independent normal errors of the origin
/// of b (axes of a) and of its heading about the z axis of a. Roll and pitch are taken from `T_a_b`.
struct AlignmentPrior {
  Pose T_a_b;
  double stddev_xy_m = 3.0;
  double stddev_z_m = 1.0;
  double stddev_yaw_rad = 0.03;
};

/// One way to lay all detections onto the map at once.
struct AlignmentHypothesis {
  Pose T_a_b;
  /// Covariance of x, y, z of the origin of b (axes of a, m) and of the heading (rad); never below that of the
  /// landmarks used, whose errors are taken as common to all of them.
  Eigen::Matrix4d cov = Eigen::Matrix4d::Zero();
  /// Log of the evidence of this mode (prior, matches and width of the mode) over the evidence of "not here before", in
  /// which every detection is new or clutter. Differences between modes of one call are log odds, too.
  double log_likelihood = 0.0;
  std::vector<int> landmark_for_detection;  ///< index into the landmarks, -1 for none; no landmark twice
  double soft_inliers = 0.0;                ///< sum over detections of the probability that their match is right
};

/// Parameters of `alignJointly`.
struct JointAlignmentConfig {
  double window_sigmas = 3.0;
  double max_window_m = 30.0;
  double cell_m = 0.5;
  double yaw_step_rad = 0.0175;
  int max_seeds = 10;
  int max_hypotheses = 5;
  double max_log_ratio = 12.0;
  int min_matches = 3;
  double static_match_prob = 0.9;
  double movable_match_prob = 0.7;
  double match_concentration = 5.0;
  double confusion_prob = 0.05;
  double noise_floor_m = 0.15;
  double tilt_stddev_rad = 0.01;
  double density_radius_m = 10.0;
  double density_height_m = 3.0;
  double distinct_m = 0.5;
  double distinct_rad = 0.01;
};

void describe(JointAlignmentConfig& config, Fields& fields);

/// Finds the rigid offsets (translation and heading) under which the detections agree with the map as a whole.
///
/// A detection matches a landmark with probability pi_c (fewer for objects that may have left) and is then normal
/// around it with the covariances of both, the transition of the landmark's class and a noise floor; otherwise it lies
/// anywhere with the density that landmarks of its class have around it, so that a match in a row of parked cars says
/// little. The share of matches is itself uncertain, so that the evidence counts detections without a landmark, too.
/// The profile of that likelihood over x, y and heading is summed up on a grid; its peaks are refined by Gauss-Newton
/// steps on the optimal one-to-one assignment, and what remains is compared with "not here before" by Laplace's
/// approximation of the evidence (MacKay, Information Theory, Inference, and Learning Algorithms, 2003, chapter 28).
///
/// Returns the distinct modes that are likelier than "not here before", most likely first; empty when there are none or
/// when they would rest on fewer than `min_matches` matches or leave the heading open. The order of detections and of
/// landmarks changes nothing. The time is proportional to the window's area and heading range; measured on one core,
/// with a prior of 5 m and 3 deg: 1 to 2 ms for 25 detections and 150 landmarks.
///
/// Throws std::invalid_argument for a point that is not finite, a covariance that is not positive definite, a class
/// that the table lacks, and a deviation of the prior that is not positive.
std::vector<AlignmentHypothesis> alignJointly(const std::vector<AlignmentPoint>& detections,
                                              const std::vector<AlignmentPoint>& landmarks, const AlignmentPrior& prior,
                                              const ClassTable& classes, const JointAlignmentConfig& config);

}  // namespace semantic_mht_slam
