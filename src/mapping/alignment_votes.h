#pragma once

#include <vector>

#include "alignment_problem.h"

namespace semantic_mht_slam {

/// Offsets near which the detections agree with the map, most promising first, at most `max_seeds`: the peaks, on a
/// grid of x, y and heading over the prior's window, of the sum over detections of the log odds of their best match,
/// plus the log prior. Matches to landmarks of other classes don't vote. Sums are of integers, so that they have no
/// order.
std::vector<AlignmentState> alignmentSeeds(const AlignmentProblem& problem, const JointAlignmentConfig& config);

}  // namespace semantic_mht_slam
