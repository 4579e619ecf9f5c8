#pragma once

#include <string>
#include <utility>
#include <vector>

#include "semantic_mht_slam/common/pose.h"
#include "semantic_mht_slam/common/pose_cov.h"
#include "semantic_mht_slam/map/ids.h"
#include "semantic_mht_slam/map/landmark.h"

namespace semantic_mht_slam {

/// How a revisit was found.
enum class ClosureSource {
  kPlace,       ///< recognised by its objects alone
  kHypotheses,  ///< agreed on by the hypotheses of a submap
  kRevisit,     ///< laid onto the earlier map near the present pose
  kRequest      ///< said by a person: holds whatever speaks against it
};

/// Name for files: `place`, `hypotheses`, `revisit` or `request`.
std::string nameOf(ClosureSource source);

/// What place recognition knows of a candidate; unknown: as below.
struct PlaceScores {
  double histogram_divergence = -1.0;  ///< of the two submaps' classes, in [0, ln 2]
  double descriptor_score = -1.0;      ///< in [0, 1]
  double topology_score = -2.0;        ///< in [-1, 1]
  double scene_score = -1.0;           ///< in [0, 1]
  double loop_prob = -1.0;             ///< in [0, 1]
};

/// A place that was recognised, or a candidate that was refused.
struct LoopClosureRecord {
  ClosureSource source = ClosureSource::kRevisit;
  KeyframeId query_keyframe;  ///< none: what was seen belongs to no keyframe
  KeyframeId match_keyframe;
  bool is_verified = false;  ///< it passed the checks of its search; whether it holds is decided by the pose graph
  bool is_accepted = false;  ///< it holds
  std::string reason;        ///< why it was refused; empty if accepted
  double score = 0.0;        ///< of the check that decided; of a place, -1 if it did not come to the geometric check
  PlaceScores place;         ///< only of kPlace
  int inliers = 0;           ///< landmark pairs that agree
  Pose T_match_query;
  PoseCov cov = PoseCov::Identity();                     ///< of T_match_query
  SubmapId came_after;                                   ///< the newest submap when it came; set by the map
  std::vector<std::pair<LandmarkId, LandmarkId>> pairs;  ///< landmark of the query, the same one before
};

}  // namespace semantic_mht_slam
