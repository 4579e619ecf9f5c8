#pragma once

#include <cstddef>
#include <vector>

#include "problem.h"

namespace semantic_mht_slam {

/// A detection and a landmark that have similar surroundings.
struct Correspondence {
  int detection = 0;
  int landmark = 0;
};

/// For each detection the `per_detection` landmarks of its class whose neighbours, by class and distance, are most
/// alike. Most are wrong.
std::vector<Correspondence> findCorrespondences(const RegistrationProblem& problem, std::size_t per_detection);

/// The state that brings corresponding points onto each other with least squares.
PlanarState motionOf(const RegistrationProblem& problem, const std::vector<Correspondence>& correspondences);

}  // namespace semantic_mht_slam
