#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "semantic_mht_slam/common/pose.h"
#include "semantic_mht_slam/map/landmark.h"

namespace semantic_mht_slam {

/// Why a candidate was refused, in the order of the checks.
enum class PlaceRefusal {
  kNone,            ///< accepted
  kUnlikePlace,     ///< the descriptors have too little in common
  kUnlikeTopology,  ///< the paper's topology score leaves too little for the sum
  kUnlikeScene,     ///< the sum of the paper's topology and landmark score is too low
  kFilter,          ///< the paper's loop filter does not believe in a loop
  kNoAlignment,     ///< no rigid motion brings objects onto each other
  kFewInliers,      ///< too few objects lie on each other
  kFewClasses,      ///< objects of a single class
  kOnALine,         ///< the objects stand in one row
  kUncertain,       ///< the covariance leaves the pose open
  kLowScore,        ///< too small a part of the scenes lies on each other
  kAmbiguous,       ///< another alignment of the same two scenes is nearly as good
  kOutsideGate,     ///< the pose found is further from the present estimate than drift explains
  kRivalPlace,      ///< another place fits nearly as well
  kUnsupported,     ///< not enough alone, and no neighbouring keyframe agrees
  kBetterCandidate  ///< right, but another keyframe of the place fits better
};

/// One line for people; empty for kNone.
std::string reasonText(PlaceRefusal refusal);

/// A candidate for a revisit, with all that is known of it.
struct PlaceMatch {
  std::size_t query = 0;  ///< number of the keyframe, in the order in which they were added
  std::size_t match = 0;  ///< the same of the earlier one
  bool accepted = false;
  PlaceRefusal refusal = PlaceRefusal::kNone;
  Pose T_match_query;
  /// Of T_match_query: order translation (m), rotation (rad), in the frame of the query, a small step on the right.
  Eigen::Matrix<double, 6, 6> cov = Eigen::Matrix<double, 6, 6>::Zero();
  int inliers = 0;
  double static_inliers = 0.0;
  double histogram_divergence = -1.0;  ///< unknown to this chain
  double descriptor_score = -1.0;      ///< in [0, 1]
  double topology_score = -2.0;        ///< unknown to this chain
  double scene_score = -1.0;           ///< share of the smaller scene that lies on the other, in [0, 1], or, in the
                                       ///< paper's chain, the landmark score; -1: unknown
  double loop_prob = -1.0;             ///< unknown to this chain
  double verification_score = -1.0;    ///< squared soft inliers over the size of the smaller scene; -1: unknown
  double rival_score = -1.0;           ///< the same of the next distinct alignment of the two scenes; -1: there is none
  double log_evidence = 0.0;           ///< of "same place" over chance
  std::vector<std::pair<LandmarkId, LandmarkId>> pairs;  ///< landmark of the query, landmark of the match
};

}  // namespace semantic_mht_slam
