#pragma once

#include "semantic_mht_slam/models/odometry_model.h"
#include "semantic_mht_slam/registration/registration.h"
#include "semantic_mht_slam/slam/revisit_search.h"

namespace semantic_mht_slam {

/// How far the base, believed to be at `T_map_base`, may be from where the earlier map has it, in the frame of
/// `T_map_base`: what the odometry's errors since keyframe `since` have come to (first order: an error of the heading
/// turns all that was driven afterwards), its unknown systematic errors included, and `revisit.base_stddev` for what
/// the map itself is off by. `more` was driven since the newest keyframe.
RegistrationPrior driftPrior(const Map& map, double tied_at_m, const Pose& T_map_base, const Motion& more,
                             const OdometryModel& odometry, const RevisitConfig& config);

/// The same after a stretch of which only the motion is known; `told_stddev_m` is the uncertainty before it.
RegistrationPrior driftPrior(const Pose& T_map_base, double told_stddev_m, const Motion& motion,
                             const OdometryModel& odometry, const RevisitConfig& config);

}  // namespace semantic_mht_slam
