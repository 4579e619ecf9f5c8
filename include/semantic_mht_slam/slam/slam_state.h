#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "semantic_mht_slam/slam/submap_content.h"

namespace semantic_mht_slam {

/// A part of what the estimator knows, as bytes of a `StateArchive`.
struct StateSection {
  std::string name;
  int version = 0;  ///< of the bytes' meaning; a reader refuses newer ones
  std::string bytes;
};

/// The section that only a map with positions by satellites has.
constexpr const char* kFixesSection = "fixes";

/// Everything that an estimator with the same class table needs to go on as if it had never stopped: the input that
/// still waits, the odometry so far, the open submap with its hypotheses, the finished submaps, keyframes, closures and
/// the pose graph.
struct SlamState {
  std::vector<StateSection> sections;
  MapContent content;                               ///< what is finished, for others; a reader of sections needs none
  std::string source;                               ///< the file that it was read from, for messages; empty: none
  std::size_t most_memory = std::size_t{1} << 30U;  ///< bytes that what is made of it may take; less for a small file
};

/// Why this program cannot read the sections of a state: one is missing, or has another version. Empty if it can.
std::string whyUnreadable(const SlamState& state);

}  // namespace semantic_mht_slam
