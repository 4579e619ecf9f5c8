#pragma once

#include <optional>
#include <vector>

#include "semantic_mht_slam/slam/slam.h"

namespace semantic_mht_slam {

/// A landmark that a submap saw.
struct DeltaLandmark {
  LandmarkId id = kNoLandmark;
  ClassIndex class_index = 0;
  double class_prob = 1.0;
  double existence_prob = 1.0;
  int observations = 0;
};

/// A landmark as a keyframe saw it, base frame of the keyframe.
struct DeltaSighting {
  std::size_t landmark = 0;  ///< its place in the list of the submap's landmarks
  Gaussian3 position;
};

struct DeltaKeyframe {
  Stamp stamp = 0;
  Motion driven;  ///< since the beginning of the drive
  Pose T_odom_base;
  std::vector<DeltaSighting> sightings;  ///< by rising landmark
};

/// What a finished submap added to a map: enough to merge the map with others, not to go on in it.
struct MapDelta {
  Stamp end = 0;
  OdometryModel odometry;
  std::optional<Pose> T_map_odom;  ///< if its odometry does not go on from the submap before
  std::vector<DeltaLandmark> landmarks;
  std::vector<SameLandmark> duplicates;
  std::vector<DeltaKeyframe> keyframes;
  std::vector<LoopClosureRecord> closures;  ///< verified ones that came with it
};

/// All that is known of a map by its deltas.
struct MapByDeltas {
  double range_factor = 1.0;
  std::vector<MapDelta> deltas;
  std::vector<bool> held;  ///< of all closures in the deltas: whether it holds
};

MapDelta deltaOf(const SlamParts& parts, SubmapId submap);

/// Of every verified closure of a map whether it holds.
std::vector<bool> heldClosures(const Map& map);

/// The map again, as the parts of an estimator. Throws InputError where the deltas contradict themselves.
SlamParts makeMap(const MapByDeltas& map, const SlamConfig& config, const ClassTable& classes);

}  // namespace semantic_mht_slam
