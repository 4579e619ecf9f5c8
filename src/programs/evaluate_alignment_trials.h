#pragma once

#include <string>
#include <vector>

#include "semantic_mht_slam/common/random.h"

#include "evaluate_alignment_scenes.h"

namespace semantic_mht_slam {

/// Size of the artificial error of a frame's pose.
struct Displacement {
  double distance_m = 0.0;
  double angle_deg = 0.0;
};

/// What became of detections.
struct MatchTally {
  int scored = 0;    ///< detections with a counterpart in the map
  int wrong = 0;     ///< of these, to another landmark
  int missed = 0;    ///< of these, to none
  int others = 0;    ///< detections without one: clutter, moving or new objects
  int accepted = 0;  ///< of these, to a landmark

  /// Wrong or missed among the scored; NaN without any.
  double share() const;
};

/// One method at one offset.
struct MethodResult {
  std::string method;
  Displacement offset;
  MatchTally tally;
};

/// What joint alignment did at one offset, apart from its associations. Right: within 0.5 m and 0.02 rad.
struct AlignmentResult {
  Displacement offset;
  int frames = 0;
  int best_right = 0;       ///< the likeliest hypothesis is right
  int any_right = 0;        ///< some hypothesis is
  int none = 0;             ///< no hypothesis
  double hypotheses = 0.0;  ///< mean number
  double nees = 0.0;        ///< mean normalised squared error of the right ones in x, y and heading: expected 3
  std::vector<double> milliseconds;
};

/// Frames laid on maps of other places, where no alignment is right.
struct ElsewhereResult {
  int frames = 0;
  int believed = 0;                 ///< with a hypothesis likelier than "not here before"
  double max_log_likelihood = 0.0;  ///< of all these
};

/// Results of all methods (nearest neighbour, Hungarian on distances, joint alignment; the first two within 10 m and a
/// class) at all offsets: none; 1, 2, 3, 5, 8 m with 0.5, 1, 2, 3, 4 deg. The direction of an offset is random and the
/// same for all methods. Joint alignment is told the same prior always: 5 m, 0.5 m in height, 3 deg.
struct AlignmentTrials {
  std::vector<MethodResult> methods;
  std::vector<AlignmentResult> alignments;
  ElsewhereResult elsewhere;
};

AlignmentTrials runAlignmentTrials(const std::vector<AlignmentScene>& scenes, const ClassTable& classes,
                                   const RegistrationConfig& config, const Rng& rng);

}  // namespace semantic_mht_slam
