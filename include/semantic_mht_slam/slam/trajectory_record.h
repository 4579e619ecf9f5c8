#pragma once

#include <cstddef>
#include <vector>

#include "semantic_mht_slam/common/stamped_pose.h"
#include "semantic_mht_slam/models/odometry_model.h"
#include "semantic_mht_slam/slam/map_fix.h"

namespace semantic_mht_slam {

/// What a trajectory is put together from: the odometry, and where the vehicle was found to be in the map. A copy, so
/// that the estimator can go on meanwhile.
struct TrajectoryRecord {
  /// A stretch of one odometry.
  struct Session {
    std::size_t first_odometry = 0;
    std::vector<MapFix> fixes;  ///< in any order; of several with one stamp the first counts
  };

  std::vector<StampedPose> odometry;  ///< T_odom_base by rising stamp, one session after the other
  std::vector<Session> sessions;      ///< by rising `first_odometry`, from 0
};

/// T_map_base at every odometry sample: the odometry, corrected so that it passes through the fixes of its session
/// (see `correctTrajectory`).
std::vector<StampedPose> trajectoryOf(const TrajectoryRecord& record);

/// Covariance of each pose of the trajectory, axes of the map: between two fixes the mean of theirs, behind the newest
/// one with what the odometry errs since. The first pose is where the map begins; a session that was never found in the
/// map is of unknown covariance.
std::vector<FixedAxesCov> trajectoryCovOf(const TrajectoryRecord& record, const OdometryModel& odometry);

}  // namespace semantic_mht_slam
