#include "first_guesses.h"

#include <algorithm>

namespace semantic_mht_slam {
namespace {

std::vector<PlanarState> guesses(const RegistrationProblem& problem, const RegistrationConfig& config) {
  switch (config.search) {
    case RegistrationSearch::kClique:
      return guessByCliques(problem);
    case RegistrationSearch::kRansac:
      return guessByRansac(problem);
    case RegistrationSearch::kVotes:
      break;
  }
  return problem.prior.is_open ? guessByPairs(problem, config.max_seeds) : guessByPoints(problem, config.max_seeds);
}

}  // namespace

std::vector<PlanarState> firstGuesses(const RegistrationProblem& problem, const RegistrationConfig& config) {
  std::vector<PlanarState> result = guesses(problem, config);
  const auto is_outside = [&](const PlanarState& state) { return !problem.prior.admits(state); };
  if (config.search != RegistrationSearch::kVotes) {
    result.erase(std::remove_if(result.begin(), result.end(), is_outside), result.end());
  }
  return result;
}

}  // namespace semantic_mht_slam
