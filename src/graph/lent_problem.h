#pragma once

#include <ceres/problem.h>

#include "ceres_manifold.h"

namespace semantic_mht_slam {

/// For a problem to which cost functions, losses and manifolds are lent, all known to be sound.
inline ceres::Problem::Options lentProblemOptions() {
  ceres::Problem::Options options;
  options.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  keepManifoldOwnership(options);
  options.disable_all_safety_checks = true;
  return options;
}

}  // namespace semantic_mht_slam
