#pragma once

#include <cstdint>
#include <vector>

namespace semantic_mht_slam {

/// The landmark that a detection was assigned to. The row counts the detections of its frame from 0.
struct AssociatedDetection {
  std::int64_t frame = 0;
  std::int64_t row = 0;
  std::int64_t landmark = 0;  ///< -1: called a false positive
};

/// What a detection really was, in the order of the detections in their file.
struct TrueDetection {
  std::int64_t frame = 0;
  std::int64_t landmark = 0;  ///< -1: clutter, below: an object that moves
};

/// How well "these two detections are the same landmark" was answered, over pairs of detections.
struct PairwiseScore {
  double precision = 0.0;  ///< share of the pairs put together that belong together
  double recall = 0.0;     ///< share of the pairs that belong together that were put together
  double f1 = 0.0;
};

/// How well detections were assigned to landmarks. Shares of nothing are 0.
struct AssociationScore {
  PairwiseScore all;    ///< over all pairs of detections of static objects; revisits must have been merged
  PairwiseScore local;  ///< over pairs within windows of 300 frames: data association without loop closures
  std::int64_t scored_detections = 0;
  std::int64_t true_detections = 0;
  double clutter_accepted = 0.0;  ///< share of the clutter that ended in a landmark
  double static_rejected = 0.0;   ///< share of the detections of static objects that were called false positives
};

/// Scores associations against the truth. Each rejected detection of a static object counts as a landmark of its own.
/// Throws std::invalid_argument for a frame or row that the truth does not have, a row that occurs twice and a landmark
/// below -1.
AssociationScore associationScore(const std::vector<TrueDetection>& truth,
                                  const std::vector<AssociatedDetection>& associations);

}  // namespace semantic_mht_slam
