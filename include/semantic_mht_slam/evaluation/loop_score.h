#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include "semantic_mht_slam/common/pose.h"

namespace semantic_mht_slam {

/// A loop closure between two frames, as far as its score needs it.
struct ClosureEstimate {
  std::int64_t query_frame = 0;
  std::int64_t match_frame = 0;
  bool accepted = false;
  Eigen::Vector3d query_in_match_m = Eigen::Vector3d::Zero();  ///< translation of T_match_query, used if accepted
};

/// How right the accepted loop closures are and how many of the revisited places have one. Shares of nothing are 0.
struct ClosureScore {
  int accepted = 0;
  int wrong = 0;
  double precision = 0.0;
  int revisited_blocks = 0;  ///< blocks of 10 frames with a frame at most 3 m from one more than 200 frames before
  int covered_blocks = 0;    ///< revisited blocks with a right closure at most 10 blocks away
  double recall = 0.0;       ///< covered / revisited
};

/// Scores loop closures against true poses of the base frame. An accepted closure is right if its translation is wrong
/// by less than 2 m. Throws std::invalid_argument for a frame that has no pose and values that are not finite.
ClosureScore closureScore(const std::vector<Pose>& T_world_base, const std::vector<ClosureEstimate>& closures);

/// How alike two frames were said to be; a larger score means more alike.
struct PairEstimate {
  std::int64_t i = 0;
  std::int64_t j = 0;
  double score = 0.0;
};

/// Quality of a similarity as a detector of revisits: true pairs are less than 3 m apart in the plane, false ones more
/// than 20 m, others do not count (protocol of Li et al., SSC, IROS 2021). NaN where there is no true pair.
struct PairScore {
  static constexpr double kUndefined = std::numeric_limits<double>::quiet_NaN();

  std::int64_t pairs = 0;
  std::int64_t positives = 0;
  double f1_max = kUndefined;
  double extended_precision = kUndefined;  ///< mean of the precision at the highest score and `recall_at_p100`
  double recall_at_p100 = kUndefined;      ///< highest recall without a false pair
  std::vector<double> precision;           ///< at each distinct score, from the highest to the lowest
  std::vector<double> recall;
};

/// Scores similarities against the true positions in the ground plane. Throws std::invalid_argument for a frame that
/// has no position and values that are not finite.
PairScore pairScore(const std::vector<Eigen::Vector2d>& positions_m, const std::vector<PairEstimate>& pairs);

}  // namespace semantic_mht_slam
