#pragma once

#include <vector>

#include "problem.h"

namespace semantic_mht_slam {

/// States near which the detections may agree with the landmarks, most promising first, at most `max_seeds`, by the
/// search that `config` chooses. All are within the window of the prior.
std::vector<PlanarState> firstGuesses(const RegistrationProblem& problem, const RegistrationConfig& config);

/// Peaks of the sum over detections of the log odds of their best match, plus the log prior. Matches to landmarks of
/// other classes don't vote.
std::vector<PlanarState> guessByPoints(const RegistrationProblem& problem, int count);

/// Peaks of the votes of pairs of detections that have a pair of landmarks of the same classes and length: each votes
/// for the motion between them.
std::vector<PlanarState> guessByPairs(const RegistrationProblem& problem, int count);

/// By maximum cliques of correspondences that keep their distances (Bailey, Mobile Robot Localisation and Mapping in
/// Extensive Outdoor Environments, 2002); each further guess is from what earlier ones leave.
std::vector<PlanarState> guessByCliques(const RegistrationProblem& problem);

/// The same by random sample consensus (PCL).
std::vector<PlanarState> guessByRansac(const RegistrationProblem& problem);

}  // namespace semantic_mht_slam
