#pragma once

#include <vector>

#include <Eigen/Core>

#include "semantic_mht_slam/mapping/joint_alignment.h"

namespace semantic_mht_slam {

/// A point of an alignment in levelled axes: those of map frame a, turned about z and moved so that the prior offset is
/// zero in both translation and heading. A motion of the world about z thus leaves the problem as it is.
struct LevelledPoint {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d cov_m2 = Eigen::Matrix3d::Identity();
  ClassIndex class_index = 0;
  int index = 0;  ///< in the list of the caller
};

/// A landmark that a detection may be.
struct AlignmentCandidate {
  int landmark = 0;
  bool is_same_class = true;
  double log_odds = 0.0;  ///< of a match against none, without the normal density: pi P(class) / ((1 - pi) density)
  Eigen::Matrix3d cov_m2 = Eigen::Matrix3d::Identity();  ///< of the residual, without the detection's own covariance
  double reach_m = 0.0;  ///< no match is better than none beyond this horizontal distance, whatever the heading
};

/// Translation (levelled axes, m) and heading (rad) relative to the prior.
using AlignmentState = Eigen::Vector4d;

/// Detections, landmarks and the matches between them that the prior's window admits.
struct AlignmentProblem {
  std::vector<LevelledPoint>
      detections;                        ///< seen from the origin of b; sorted, so that the caller's order is forgotten
  std::vector<LevelledPoint> landmarks;  ///< sorted
  std::vector<std::vector<AlignmentCandidate>> candidates;  ///< of each detection
  std::vector<bool> is_static;                              ///< of each detection
  std::vector<bool> is_covered;  ///< of each detection: there are landmarks around it, it should be in the map
  Eigen::Vector4d prior_stddev = Eigen::Vector4d::Ones();  ///< of the state
  Eigen::Vector4d window = Eigen::Vector4d::Ones();        ///< largest state that is looked for, each way
  double prior_heading_rad = 0.0;                          ///< turn from levelled axes to those of a
};

/// Checks the input (see `alignJointly`) and prepares it.
AlignmentProblem makeAlignmentProblem(const std::vector<AlignmentPoint>& detections,
                                      const std::vector<AlignmentPoint>& landmarks, const AlignmentPrior& prior,
                                      const ClassTable& classes, const JointAlignmentConfig& config);

/// Rotation about z.
Eigen::Matrix3d headingRotation(double yaw_rad);

}  // namespace semantic_mht_slam
