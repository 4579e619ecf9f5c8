#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "semantic_mht_slam/merging/joined_map.h"
#include "semantic_mht_slam/merging/overlap.h"

namespace semantic_mht_slam {

/// What came of two maps.
struct MergedPair {
  std::size_t a = 0;  ///< places in the list of maps, a < b
  std::size_t b = 0;
  OverlapPosterior overlap;  ///< as the two alone say
  bool is_decided = false;   ///< they overlap, and nothing speaks against it
  bool is_joined = false;    ///< they are in one map, maybe through others
  double posterior = 0.0;    ///< of their being one map as they lie there; if they are not joined, of the likeliest way
  int closures = 0;          ///< between them, that hold
  std::string reason;        ///< why they are not joined, or how they are if not by themselves
};

/// Maps that became one.
struct MergedGroup {
  std::vector<std::size_t> maps;    ///< rising
  std::optional<JoinedMap> joined;  ///< of several maps, or of the first one if nothing was joined
};

struct MergeResult {
  std::vector<MergedPair> pairs;
  std::vector<MergedGroup> groups;   ///< largest first; every map is in one, an island in a group of its own
  std::vector<std::string> reasons;  ///< of each map why it is an island; empty if it is none
};

/// What two maps alone say.
struct ComparedPair {
  OverlapPosterior overlap;
  std::vector<LoopClosureRecord> closures;  ///< if they overlap: keyframes of b found in a
};

/// Comparisons of maps by their names, for who merges them again and again.
class PairMemory {
 public:
  const ComparedPair* find(const std::string& a, const std::string& b) const;
  const ComparedPair& keep(const std::string& a, const std::string& b, ComparedPair pair);

  /// Needed when the map of that name has changed.
  void forget(const std::string& name);

  /// Forgets everything if the lengths of the comparison are no longer the same.
  void expect(double range_factor);

 private:
  std::map<std::pair<std::string, std::string>, ComparedPair> pairs_;
  double range_factor_ = 1.0;
};

/// Called with what is done next; what it throws ends the merging.
using MergeProgress = std::function<void(const std::string& step)>;

/// The settings that are common to finished maps.
MergeSettings mergeSettings(const std::vector<MergeMap>& maps, const SlamConfig& config, const ClassTable& classes);

/// Makes one map of those that show one place. Two are joined if the posterior of their overlap is decided; the graph
/// of all of them must bear out the closures between them, or else they come apart again. No frame in common is needed.
/// Throws InputError for an empty map. Pairs that are in the memory are not compared again, the others are kept there.
MergeResult mergeMaps(std::vector<MergeMap>& maps, const SlamConfig& config, const ClassTable& classes,
                      const MergeConfig& merge = {}, const MergeProgress& progress = {}, PairMemory* memory = nullptr);

}  // namespace semantic_mht_slam
