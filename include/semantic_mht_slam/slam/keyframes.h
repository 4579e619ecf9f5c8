#pragma once

#include <vector>

#include "semantic_mht_slam/common/config.h"
#include "semantic_mht_slam/map/keyframe.h"
#include "semantic_mht_slam/map/submap.h"
#include "semantic_mht_slam/models/frame.h"
#include "semantic_mht_slam/models/odometry_model.h"

namespace semantic_mht_slam {

/// How finished submaps are cut into keyframes, the nodes of the pose graph.
struct KeyframeConfig {
  Length spacing_m{5.0};
  Length sighting_floor_m{0.1};
  double vertical_floor_m = 1.0;
};

void describe(KeyframeConfig& config, Fields& fields);

/// The keyframes of a submap, and what each saw.
struct CutSubmap {
  std::vector<Keyframe> keyframes;
  std::vector<std::vector<Sighting>> sightings;  ///< of each keyframe, by rising landmark id
};

/// Cuts a submap into keyframes. `frames` are those of the submap in their order; `driven` is the motion before the
/// first of them, and every detection states its covariance. Every landmark of the submap with at least `keep_prob` of
/// existence gets one sighting a keyframe that sees it: the information-weighted mean of its detections, carried to the
/// keyframe by odometry, with a floor for errors that they share.
CutSubmap cutIntoKeyframes(const Submap& submap, const std::vector<Frame>& frames, Motion driven, double keep_prob,
                           const OdometryModel& odometry, const KeyframeConfig& config);

}  // namespace semantic_mht_slam
