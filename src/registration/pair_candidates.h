#pragma once

#include <vector>

#include "problem.h"

namespace semantic_mht_slam {

/// For each detection the landmarks that it may be within the window of the prior: those with which, at some state, a
/// match is likelier than none. `problem.candidates` is not used.
std::vector<std::vector<PairCandidate>> pairCandidates(const RegistrationProblem& problem,
                                                       const RegistrationConfig& config);

}  // namespace semantic_mht_slam
