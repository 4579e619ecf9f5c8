#pragma once

#include <vector>

#include "semantic_mht_slam/merging/merge_map.h"

namespace semantic_mht_slam {

/// A closure between a keyframe of one map and one of an earlier map of the same join.
struct CrossClosure {
  std::size_t query_map = 0;  ///< place in the list of the maps that are joined, greater than `match_map`
  std::size_t match_map = 0;
  LoopClosureRecord record;  ///< keyframes and landmarks as their own maps number them
};

/// A map in a joined map: how its numbers go on there.
struct JoinedMember {
  const MergeMap* map = nullptr;
  Pose T_joined_map;  ///< a first guess at where its frame lies
  std::size_t first_keyframe = 0;
  std::size_t first_submap = 0;
  LandmarkId landmark_offset = 0;  ///< a landmark's id in the joined map less that in its own
};

/// What a session needs that goes on in the joined map, and how the maps went into it.
struct JoinedMap {
  SlamParts parts;
  std::vector<JoinedMember> members;
};

/// One map of several: submaps, keyframes, landmarks and sessions follow each other as if one vehicle had driven them,
/// with an unknown way between two maps; closures within the maps stay, those across are decided by the pose graph,
/// and which landmarks are one follows from them. Its frame is that of the first map. `members` need `map` and
/// `T_joined_map`; the closures must be verified ones.
JoinedMap joinMaps(std::vector<JoinedMember> members, std::vector<CrossClosure> closures,
                   const MergeSettings& settings);

/// Landmarks of a joined map, each once, in its frame.
std::vector<MixtureLandmark> landmarksOf(const JoinedMap& joined);

/// The joined trajectory cut into those of the members, each by all of its odometry; empty for one without odometry.
std::vector<std::vector<StampedPose>> cutByMember(const JoinedMap& joined, const std::vector<StampedPose>& trajectory);

}  // namespace semantic_mht_slam
