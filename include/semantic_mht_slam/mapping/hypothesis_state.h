#pragma once

#include <vector>

#include "semantic_mht_slam/common/state_archive.h"
#include "semantic_mht_slam/mapping/hypothesis.h"

namespace semantic_mht_slam {

void transfer(StateArchive& archive, PoseOffset& offset);
void transfer(StateArchive& archive, Existence& existence);
void transfer(StateArchive& archive, TrackedLandmark& landmark);

/// The leaves of a tree. What they share (landmarks, the beginnings of their histories) is written once and shared
/// again afterwards.
void transferLeaves(StateArchive& archive, std::vector<MapHypothesis>& leaves);

}  // namespace semantic_mht_slam
