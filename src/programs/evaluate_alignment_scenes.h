#pragma once

#include <optional>
#include <vector>

#include "semantic_mht_slam/io/dataset.h"
#include "semantic_mht_slam/registration/registration.h"

namespace semantic_mht_slam {

/// A landmark number per detection, per frame: -1 clutter, -2 moving.
using TrueLandmarks = std::vector<std::vector<int>>;

/// One frame of a later pass and the map that an earlier pass made of the same place.
struct AlignmentScene {
  std::size_t frame = 0;
  std::vector<RegistrationPoint> detections;    ///< base frame
  std::vector<RegistrationPoint> landmarks;     ///< map frame
  std::vector<std::vector<int>> right_matches;  ///< of each detection; empty: it has no counterpart and is not scored
  Pose T_map_base;                              ///< the truth, registered where poses are not exact
};

/// Scenes of every `step`-th frame that comes back to within 3 m of one more than 200 frames before. The map is made of
/// the frames within `half_length_m` of travelled distance around that one.
///
/// With `truth` a detection's counterparts are the landmarks whose sightings are mostly of the same true landmark.
/// Without it, frame and map are registered at the true offset first (poses of revisits may contradict each other by
/// more than the distance between a detection and its landmark): mutual nearest neighbours, starting at 2 m, moved onto
/// each other until they stay. Counterparts are then mutual nearest neighbours of a class within 0.5 m, movable ones
/// within 1.5 m. Frames that the registration moves by more than 2 m or leaves with fewer than three counterparts are
/// left out.
std::vector<AlignmentScene> alignmentScenes(const Dataset& dataset, const ClassTable& classes,
                                            const std::optional<TrueLandmarks>& truth, std::size_t step,
                                            double half_length_m);

}  // namespace semantic_mht_slam
