#pragma once

#include "semantic_mht_slam/slam/slam.h"

namespace semantic_mht_slam {

// Keeps `SlamParts::latest`, the pose of the base at the newest odometry sample with its uncertainty.

/// Takes the next sample of the odometry, before it is kept.
void reckon(const StampedPose& next, SlamParts& parts);

/// From now on the pose follows by odometry from the newest keyframe, unless a later fix is known.
void tieToNewestKeyframe(SlamParts& parts);

/// Keeps the newest fix of a localizer; the pose follows from it.
void takeFix(const Localizer& localizer, SlamParts& parts);

/// The pose at the newest sample, from outside.
void expectPose(const Pose& T_map_base, double stddev_m, double stddev_rad, SlamParts& parts);

/// The first keyframe has come: how exact it is relative to the first pose.
void noteStart(SlamParts& parts);

}  // namespace semantic_mht_slam
