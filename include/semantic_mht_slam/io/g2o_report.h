#pragma once

#include <string>

#include "semantic_mht_slam/graph/batch_solver.h"
#include "semantic_mht_slam/io/g2o_file.h"

namespace semantic_mht_slam {

/// What a run on a g2o file did.
struct G2oReport {
  BatchReport solver;
  double seconds = 0.0;      ///< wall clock, without reading and writing
  double cpu_seconds = 0.0;  ///< all threads, without reading and writing
};

/// The report as JSON: initial_cost, final_cost, accepted_cost, iterations, converged, start, seconds, cpu_seconds,
/// vertices, points, edges, rejected_loops (from, to, mahalanobis_sq), projected_edges.
std::string formatReport(const G2oFile& file, const G2oReport& report);

}  // namespace semantic_mht_slam
