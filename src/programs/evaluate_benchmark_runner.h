#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "evaluate_benchmark_cells.h"

namespace semantic_mht_slam {

/// How many runs were made, found complete, and failed.
struct RunCounts {
  std::size_t made = 0;
  std::size_t found = 0;
  std::size_t failed = 0;
};

/// Runs `slam_offline`, which stands beside this program, for each cell whose folder does not hold the complete result
/// of the same configuration, input files and program; at most `request.jobs` at once, with progress on standard error.
/// A run that fails is told there, sets the failure of its cells and does not stop the others. Throws InputError for a
/// configuration that is refused, before anything runs.
RunCounts runCells(const BenchmarkRequest& request, std::vector<BenchmarkCell>& cells);

/// The parameters of the file `config`, changed by `settings` (KEY=VALUE), as YAML. Throws InputError.
std::string effectiveConfig(const std::string& config, const std::vector<std::string>& settings);

/// Hash of the content of `slam_offline` and the libraries that shape what it computes: a name for the program that is
/// true whatever the state of the source tree.
std::string programHash();

}  // namespace semantic_mht_slam
