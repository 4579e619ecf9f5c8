#pragma once

#include <vector>

#include "semantic_mht_slam/mapping/hypothesis.h"

namespace semantic_mht_slam {

/// Merges hypotheses that became equal: the same landmarks within a tenth of their deviation, and the same associations
/// in the last frames. The earlier one in the list stays, with the summed weight. `log_weight` must be normalised and
/// the list sorted by falling weight.
void mergeEqualHypotheses(std::vector<MapHypothesis>& hypotheses);

/// True if the two describe the same map by the rule above.
bool areEqual(const MapHypothesis& a, const MapHypothesis& b);

}  // namespace semantic_mht_slam
