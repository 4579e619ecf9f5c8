#pragma once

#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "semantic_mht_slam/common/pose.h"
#include "semantic_mht_slam/evaluation/rigid_alignment.h"

namespace semantic_mht_slam {

/// How far an estimated trajectory is from the truth. NaN where a figure is not defined (a drive that is too short, no
/// revisited place).
struct TrajectoryError {
  static constexpr double kUndefined = std::numeric_limits<double>::quiet_NaN();

  double first_m = kUndefined;         ///< RMSE of the positions with the first poses made equal
  double se3_m = kUndefined;           ///< RMSE of the positions after `rigidAlignment`
  double running_mean_m = kUndefined;  ///< mean over the frames of `runningRmse`, first poses made equal
  double running_std_m = kUndefined;   ///< its standard deviation
  double t_rel_percent =
      kUndefined;  ///< translation error over 100, 200, ... 800 m of driving (Geiger et al., CVPR 2012)
  double r_rel_deg_per_100m = kUndefined;  ///< rotation error over the same stretches
  double revisit_m = kUndefined;  ///< median error of the relative translation between a frame and earlier ones at
                                  ///< the same place (at most 3 m apart, more than 200 frames before)
  double end_m = kUndefined;      ///< error of the last position with the first poses made equal
};

/// The figures with their names in reports, in the order of the struct.
std::vector<std::pair<std::string, double>> namedFigures(const TrajectoryError& error);

/// A pose as a file has it. A rotation printed with seven digits is no exact one; projecting it onto the rotations, as
/// `Pose` does, shifts positions by up to 1e-5 m on a drive of some kilometres.
using PoseMatrix = Eigen::Affine3d;

/// Errors of `estimate` against `truth`, both T_world_sensor of the same sensor, one pose a frame.
/// Throws std::invalid_argument for no poses, different numbers of poses and values that are not finite.
TrajectoryError trajectoryError(const std::vector<Pose>& truth, const std::vector<Pose>& estimate);
TrajectoryError trajectoryError(const std::vector<PoseMatrix>& truth, const std::vector<PoseMatrix>& estimate);

/// Errors frame by frame, metres; each list is as long as the trajectory.
struct FrameErrors {
  std::vector<double> unaligned_m;     ///< with the first poses made equal
  std::vector<double> aligned_m;       ///< after `rigidAlignment`
  std::vector<double> running_rmse_m;  ///< `runningRmse` of `unaligned_m`
};

/// As `trajectoryError`, frame by frame.
FrameErrors frameErrors(const std::vector<PoseMatrix>& truth, const std::vector<PoseMatrix>& estimate);

/// The trajectory moved rigidly so that its first pose is `first`. An empty one stays empty.
std::vector<PoseMatrix> startingAt(const PoseMatrix& first, const std::vector<PoseMatrix>& trajectory);

/// Root mean square of the values up to and with each place of the list.
std::vector<double> runningRmse(const std::vector<double>& errors_m);

/// Length of the path through the positions, metres.
double pathLength(const std::vector<PoseMatrix>& trajectory);

/// Poses as matrices.
std::vector<PoseMatrix> poseMatrices(const std::vector<Pose>& poses);

}  // namespace semantic_mht_slam
