#pragma once

#include <ceres/solver.h>

namespace semantic_mht_slam {

/// Iterations of a solver beyond the look at where it began.
inline int iterationsOf(const ceres::Solver::Summary& summary) {
  return summary.iterations.empty() ? 0 : static_cast<int>(summary.iterations.size()) - 1;
}

}  // namespace semantic_mht_slam
