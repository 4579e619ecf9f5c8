#pragma once

#include <vector>

#include <Eigen/Core>

#include "semantic_mht_slam/map/landmark.h"
#include "semantic_mht_slam/models/odometry_model.h"

namespace semantic_mht_slam {

constexpr int kRangeErrors = 2;  ///< that all detections have in common: a scale, and so much too far in metres

/// A detection of a stretch of driving, and the landmark that it was assigned to.
struct StretchObservation {
  int keyframe = 0;                                      ///< index into the stretch's poses
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  ///< base frame
  Eigen::Matrix3d cov_m2 = Eigen::Matrix3d::Identity();  ///< base frame
  LandmarkId landmark = kNoLandmark;
};

/// A stretch of driving by odometry, and what was seen on it.
struct OdometryStretch {
  std::vector<Pose> T_stretch_base;  ///< of the keyframes, by odometry
  std::vector<Motion> motion;        ///< from each keyframe to the next
  std::vector<StretchObservation> observations;
};

/// What the detections of a stretch know of the error of each of its steps, whatever the landmarks are: information
/// matrix and vector of the errors e_k, three numbers a step, true step less odometry's: on the plane (along, across,
/// heading) in the axes of the keyframe before; vertically (up, roll, pitch) in the axes of the stretch's frame. What
/// all ranges are off by stays in them: a detector that measures too short looks like an odometry that counts too much.
struct StepInformation {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd vector;
  std::vector<Motion> motion;
  Eigen::MatrixXd effect;  ///< errors per unit of the systematic ones; a column each, in the order of SystematicErrors
  Eigen::MatrixXd coupling;      ///< what a unit of each range error takes from `vector`; on the plane only
  Eigen::MatrixXd range_matrix;  ///< information on the range errors were the steps known
  Eigen::VectorXd range_vector;
};

/// Position and heading: the stretch is solved for poses and landmarks together (bundle adjustment on the plane with
/// the odometry under `model` as prior and Cauchy weights against wrong associations), landmarks are eliminated and the
/// odometry's part taken off again. Empty matrix if nothing was seen from two keyframes.
StepInformation planarInformation(const OdometryStretch& stretch, const OdometryModel& model);

/// The same for height, roll and pitch, whose equations are linear.
StepInformation verticalInformation(const OdometryStretch& stretch, const OdometryModel& model);

}  // namespace semantic_mht_slam
