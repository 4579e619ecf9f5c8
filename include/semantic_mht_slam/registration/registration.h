#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "semantic_mht_slam/common/pose.h"
#include "semantic_mht_slam/map/scene.h"
#include "semantic_mht_slam/models/class_table.h"
#include "semantic_mht_slam/registration/registration_config.h"

namespace semantic_mht_slam {

/// A classified point with uncertainty, in the frame of its set: a detection, or a landmark of a map.
struct RegistrationPoint {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d cov_m2 = Eigen::Matrix3d::Identity();
  ClassIndex class_index = 0;
};

/// The objects of a scene, in the same order.
std::vector<RegistrationPoint> registrationPoints(const Scene& scene);

/// Where frame b is believed to be in frame a, and how far that may be off: independent normal errors of the origin of
/// b (axes of a) and of its heading about the z axis of a. Roll and pitch are those of `T_a_b` but for
/// `RegistrationConfig::tilt_stddev_rad`.
struct RegistrationPrior {
  Pose T_a_b;
  double stddev_xy_m = 3.0;
  double stddev_z_m = 1.0;
  double stddev_yaw_rad = 0.03;
};

/// Two points that are the same, by their places in the lists of the caller.
struct RegisteredPair {
  int a = 0;
  int b = 0;
  double right_prob = 0.0;  ///< that they are, rather than the point of b having no counterpart
};

/// One way to lay all points of b onto those of a at once.
struct RegistrationMode {
  Pose T_a_b;
  /// Of T_a_b: order translation (m), rotation (rad), both in frame b, a small step on the right. Of what the pairs
  /// say: but for roll and pitch it does not hold the prior, so that whoever fuses the two counts nothing twice.
  Eigen::Matrix<double, 6, 6> cov = Eigen::Matrix<double, 6, 6>::Identity();
  /// Log of the evidence of this mode (prior, pairs and width of the mode) over the evidence of "not here", in which
  /// every point of b is new or clutter. Differences between modes of one call are log odds, too.
  double log_evidence = 0.0;
  std::vector<RegisteredPair> pairs;  ///< one to one, in an order that depends on the points alone

  /// Covariance of x, y, z of the origin of b (axes of a, m) and of the heading about the z axis of a (rad).
  Eigen::Matrix4d headingCov() const;
};

/// Finds the rigid motions under which the points of b agree with those of a as a whole.
///
/// A point of b matches one of a with probability pi_c (fewer for objects that may have left) and is then normal around
/// it with the covariances of both, the transition of the class and a noise floor; otherwise it lies anywhere with the
/// density that points of its class have around it, so that a match in a row of parked cars says little. The share of
/// matches is itself uncertain, so that the evidence counts points without a counterpart, too. First guesses come from
/// one grid over x, y and heading, in which single points vote (with a prior) or pairs of points (without one, when any
/// heading and an origin within `max_offset_m` are alike), or from another `search`. They climb by Gauss-Newton
/// steps on the optimal one-to-one assignment in position and heading; what is reached is compared with "not here" by
/// Laplace's approximation of the evidence (MacKay, Information Theory, Inference, and Learning Algorithms, 2003,
/// chapter 28), and its pose follows from its pairs in all six degrees of freedom (`poseFromPairs`).
///
/// Returns the distinct modes that are likelier than "not here", most likely first; empty when there are none or when
/// they would rest on fewer than `min_matches` pairs or leave the heading open. The order of the points changes
/// nothing. Measured on one core: 1 to 2 ms for 25 points on 150 with a prior of 5 m and 3 deg; the time is
/// proportional to the window's area and heading range.
///
/// Throws std::invalid_argument for a point that is not finite, a covariance that is not positive definite, a class
/// that the table lacks, and a standard deviation of the prior that is not positive.
std::vector<RegistrationMode> align(const std::vector<RegistrationPoint>& a, const std::vector<RegistrationPoint>& b,
                                    const std::optional<RegistrationPrior>& prior, const ClassTable& classes,
                                    const RegistrationConfig& config);

}  // namespace semantic_mht_slam
