#pragma once

#include <vector>

#include <Eigen/Core>

#include "semantic_mht_slam/common/config.h"
#include "semantic_mht_slam/common/pose.h"
#include "semantic_mht_slam/map/landmark.h"
#include "semantic_mht_slam/models/class_table.h"
#include "semantic_mht_slam/models/detection.h"
#include "semantic_mht_slam/models/odometry_model.h"

namespace semantic_mht_slam {

class StateArchive;

/// How the bias of centroids is found out while driving.
struct BiasConfig {
  bool enabled = true;
  double prior_factor = 3.0;
  double height_stddev_m = 0.2;
  double scale_stddev = 0.03;
  double scale_change_stddev = 0.01;
  int min_observations = 4;
};

void describe(BiasConfig& config, Fields& fields);

/// What a centroid is off by, with the variance of that estimate.
struct CentroidBiasEstimate {
  double range_m = 0.0;   ///< along the line of sight; negative: nearer than the object
  double height_m = 0.0;  ///< against the height that is seen from near
  double range_variance_m2 = 0.0;
  double height_variance_m2 = 0.0;
};

/// A detection of a stretch of driving, and the landmark that it was assigned to.
struct BiasObservation {
  int keyframe = 0;                                      ///< index into the stretch's poses
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  ///< base frame, as detected
  Eigen::Matrix3d cov_m2 = Eigen::Matrix3d::Identity();  ///< base frame
  ClassIndex class_index = 0;
  LandmarkId landmark = kNoLandmark;
};

/// A stretch of driving: odometry poses in one frame, and what was seen from them.
struct BiasStretch {
  std::vector<Pose> T_stretch_base;
  std::vector<BiasObservation> observations;
};

/// Bias of centroids along the line of sight and in height, by class and range: a lidar sees the side of an object that
/// faces it, and of a far one only the upper part. Piecewise linear over the range.
///
/// Estimated from landmarks that were seen from several places, without knowing where they are: a centroid that is too
/// near moves with the sensor as it passes. Each stretch gives linear equations in the coefficients of all classes, the
/// landmarks and the errors of the odometry: a random walk of position, height and heading, an error of the scale and
/// of the direction of motion, each with a part that all stretches share. Landmarks and odometry errors are eliminated
/// (Schur complement), what remains is added up. A scale error of the odometry looks like a bias that grows with the
/// range, for all classes alike; with the scale in the equations, only what tells the two apart counts as evidence.
/// Classes whose centroid moves between passes by more than the detector's noise (buildings, fences: another part of
/// them is seen) have no one place to be off from and are left alone.
/// The prior is no bias. The height is relative to that seen from near, as only its change can be observed.
class CentroidBias {
 public:
  CentroidBias(const BiasConfig& config, const ClassTable& classes);

  /// Takes one stretch. Landmarks with fewer than `min_observations` are left out, wrong associations are weighed down.
  void add(const BiasStretch& stretch, const OdometryNoise& odometry);

  /// Whether objects of the class stand where they stood, and are seen at one place from everywhere but for the bias.
  bool hasOnePlace(ClassIndex class_index) const { return has_one_place_[static_cast<std::size_t>(class_index)]; }

  /// The bias of a class at a range. Zero with zero variance when switched off.
  CentroidBiasEstimate at(ClassIndex class_index, double range_m) const;

  /// The detection without its bias; a covariance that it has grows by that of the bias.
  Detection corrected(const Detection& detection) const;

  /// Covariance that the bias's uncertainty adds to a detection at `position_m` (base frame), m^2; at most the class
  /// table's variance, which is meant to cover what is not known yet.
  Eigen::Matrix3d uncertainty(ClassIndex class_index, const Eigen::Vector3d& position_m) const;

  /// Relative error of the odometry's scale that all stretches share (true length = (1 + scale) times odometry's).
  double odometryScale() const;

  /// Its standard deviation: ranges that are all off by a factor look like it, so that it is never known exactly.
  double scaleStddev() const;

  /// All that it has learned (see `StateArchive`).
  void transfer(StateArchive& archive);

 private:
  void forget();
  /// Takes what another one has learned, whose classes with a bias have these places. Classes that had none are as at
  /// the beginning; what is known of the others holds whatever the bias of those was that have none any more.
  void adopt(const std::vector<int>& place, const Eigen::MatrixXd& information, const Eigen::VectorXd& vector);
  bool solve();

  BiasConfig config_;
  std::vector<double> stddev_m_;  ///< of each class, as the class table has it
  std::vector<bool> has_one_place_;
  std::vector<int> place_;       ///< of each class among those that have a bias; -1: has none
  int biased_count_ = 0;         ///< classes that have one
  Eigen::MatrixXd information_;  ///< of the coefficients
  Eigen::VectorXd vector_;
  Eigen::VectorXd mean_;
  Eigen::MatrixXd cov_;
};

}  // namespace semantic_mht_slam
