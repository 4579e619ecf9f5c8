#pragma once

#include <optional>
#include <vector>

#include "semantic_mht_slam/slam/slam.h"
#include "semantic_mht_slam/slam/submap_content.h"

namespace semantic_mht_slam {

/// Keyframes of a submap that a landmark can name, by a byte; the first ones.
constexpr std::size_t kNamedKeyframes = 256;

/// A landmark that a submap saw.
struct DeltaLandmark {
  LandmarkId id = kNoLandmark;
  ClassIndex class_index = 0;
  double class_prob = 1.0;
  double existence_prob = 1.0;
  int observations = 0;
  std::size_t keyframe = 0;  ///< its place in the list of the submap's keyframes: that saw it best
  Gaussian3 position;        ///< as all keyframes of the submap together saw it, base frame of that keyframe
};

struct DeltaKeyframe {
  Stamp stamp = 0;
  Motion driven;  ///< since the beginning of the drive
  /// By odometry; within a submap smoothed by what its keyframes saw, as an odometry with the same systematic errors
  /// would have it. Of the first keyframe of all, its pose in the map.
  Pose T_previous_keyframe;
  std::vector<std::size_t> landmarks;  ///< what it shows, as places in the list of the submap's landmarks; rising
};

/// What a finished submap added to a map: enough to merge the map with others, not to go on in it.
struct MapDelta {
  Stamp end = 0;
  OdometryModel odometry;
  bool begins_session = false;  ///< the first step is no odometry, but a pose that was found in the map
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

SubmapContent contentOf(const SlamParts& parts, SubmapId submap);
MapContent contentOf(const SlamParts& parts);

MapDelta deltaOf(const SubmapContent& content);
MapDelta deltaOf(const SlamParts& parts, SubmapId submap);

/// Of every verified closure of a map whether it holds.
std::vector<bool> heldClosures(const Map& map);

/// The map again, as the parts of an estimator. Throws InputError where the deltas contradict themselves.
SlamParts makeMap(const MapByDeltas& map, const SlamConfig& config, const ClassTable& classes);

/// The same as a state to go on from. What had been learned of the detector and of the odometry is not in it.
SlamState makeState(const MapByDeltas& map, const SlamConfig& config, const ClassTable& classes);

}  // namespace semantic_mht_slam
