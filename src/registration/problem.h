#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "semantic_mht_slam/registration/registration.h"

// The points of b are called detections here, those of a landmarks.
namespace semantic_mht_slam {

/// A point in levelled axes: those of frame a, turned about z and moved so that the prior offset is zero in both
/// translation and heading. A motion of the world about z thus leaves the problem as it is.
struct LevelledPoint {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  /// Of a detection with what the error of the tilt adds to it; of a landmark with what a pair errs besides the
  /// covariances of its points.
  Eigen::Matrix3d cov_m2 = Eigen::Matrix3d::Identity();
  ClassIndex class_index = 0;
  int index = 0;  ///< in the list of the caller
};

/// A landmark that a detection may be.
struct PairCandidate {
  int landmark = 0;
  bool is_same_class = true;
  double log_odds = 0.0;  ///< of a match against none, without the normal density: pi P(class) / ((1 - pi) density)
  double reach_m = 0.0;   ///< no match is better than none beyond this horizontal distance, whatever the heading
};

/// Translation (levelled axes, m) and heading (rad) relative to the prior.
using PlanarState = Eigen::Vector4d;

/// What is known of the state before any point is looked at: a normal distribution, or, in x, y and heading, a uniform
/// one over the window.
struct StatePrior {
  bool is_open = false;  ///< uniform; the heading goes all the way round
  Eigen::Vector4d stddev = Eigen::Vector4d::Ones();
  Eigen::Vector4d information = Eigen::Vector4d::Ones();  ///< of the normal distribution; zero where it is uniform
  Eigen::Vector4d window = Eigen::Vector4d::Ones();       ///< largest state that is looked for, each way
  double log_peak = 0.0;  ///< log density at zero, times (2 pi)^2 so that Laplace's approximation needs no more of it

  /// Of the density at a state over that at zero.
  double logRatio(const PlanarState& state) const { return -0.5 * state.cwiseAbs2().dot(information); }
  bool admits(const PlanarState& state) const;
};

/// Detections, landmarks and the matches between them that the prior's window admits.
struct RegistrationProblem {
  std::vector<LevelledPoint> detections;  ///< seen from the origin of b; sorted: the caller's order is forgotten
  std::vector<LevelledPoint> landmarks;   ///< sorted
  std::vector<std::vector<PairCandidate>> candidates;  ///< of each detection
  std::vector<double> extra_variance_m2;               ///< of each class: transition and noise floor of a pair
  std::vector<bool> is_static;                         ///< of each class
  StatePrior prior;
  double cell_m = 0.0;             ///< of the voting grid
  double yaw_step_rad = 0.0;       ///< the same
  double prior_heading_rad = 0.0;  ///< turn from levelled axes to those of a
};

/// Checks the input (see `align`) and prepares it.
RegistrationProblem makeProblem(const std::vector<RegistrationPoint>& detections,
                                const std::vector<RegistrationPoint>& landmarks,
                                const std::optional<RegistrationPrior>& prior, const ClassTable& classes,
                                const RegistrationConfig& config);

/// Rotation about z.
Eigen::Matrix3d headingRotation(double yaw_rad);

}  // namespace semantic_mht_slam
