#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "semantic_mht_slam/common/pose.h"
#include "semantic_mht_slam/graph/pose_graph.h"
#include "semantic_mht_slam/map/landmark.h"

namespace semantic_mht_slam {

/// How a revisit was found.
enum class ClosureSource {
  kPlace,       ///< recognised by its objects alone
  kHypotheses,  ///< agreed on by the hypotheses of a submap
  kRevisit      ///< laid onto the earlier map near the present pose
};

/// Name for files: `place`, `hypotheses` or `revisit`.
std::string nameOf(ClosureSource source);

/// A place that was recognised, or a candidate that was refused.
struct LoopClosureRecord {
  ClosureSource source = ClosureSource::kRevisit;
  int query_keyframe = 0;
  int match_keyframe = 0;
  bool is_accepted = false;
  std::string reason;  ///< why it was refused; empty if accepted
  double score = 0.0;  ///< of the check that decided
  int inliers = 0;     ///< landmark pairs that agree
  Pose T_match_query;
  PoseCov cov = PoseCov::Identity();                     ///< of T_match_query
  std::vector<std::pair<LandmarkId, LandmarkId>> pairs;  ///< landmark of the query, the same landmark before
};

}  // namespace semantic_mht_slam
