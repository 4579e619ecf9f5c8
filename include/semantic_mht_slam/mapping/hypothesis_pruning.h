#pragma once

#include <vector>

#include "semantic_mht_slam/common/random.h"
#include "semantic_mht_slam/mapping/hypothesis.h"
#include "semantic_mht_slam/mapping/mapper_config.h"

namespace semantic_mht_slam {

/// Makes the weights sum to 1 and sorts by falling weight; equal ones keep their order.
void normalizeAndSort(std::vector<MapHypothesis>& leaves);

/// log of the least weight with which a hypothesis is kept; -infinity for an estimator that has another rule.
double logMinWeight(const MapperConfig& config);

/// Drops hypotheses by the rule of the estimator: those below `min_weight` and what KLD resampling does not draw
/// (paper, section II-B), or all but the best third when there are too many. `leaves` must be normalised and sorted,
/// and is afterwards.
void pruneHypotheses(const MapperConfig& config, std::vector<MapHypothesis>& leaves, Rng& rng);

}  // namespace semantic_mht_slam
