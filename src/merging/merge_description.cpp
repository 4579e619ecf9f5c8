#include "merge_description.h"

#include <algorithm>

namespace semantic_mht_slam {
namespace {

bool has(const MergedGroup& group, std::size_t map) {
  return std::binary_search(group.maps.begin(), group.maps.end(), map);
}

void describeGroup(const MergedGroup& group, std::vector<MergedPair>& pairs) {
  double least = 1.0;  // posterior of what holds the group together
  for (const MergedPair& pair : pairs) {
    if (pair.is_decided && has(group, pair.a)) least = std::min(least, pair.posterior);
  }
  for (MergedPair& pair : pairs) {
    if (!has(group, pair.a) || !has(group, pair.b)) continue;
    pair.is_joined = true;
    if (pair.is_decided) continue;
    pair.posterior = least;
    pair.reason = "joined through other maps; the two alone: " + pair.reason;
  }
}

/// Why a map was not joined with the one that it most likely overlaps.
std::string islandReason(std::size_t map, const std::vector<MergeMap>& maps, const std::vector<MergedPair>& pairs) {
  const MergedPair* nearest = nullptr;
  for (const MergedPair& pair : pairs) {
    if (pair.a != map && pair.b != map) continue;
    if (nearest == nullptr || pair.posterior > nearest->posterior) nearest = &pair;
  }
  if (nearest == nullptr) return "";
  return "with " + maps[nearest->a == map ? nearest->b : nearest->a].name() + ": " + nearest->reason;
}

}  // namespace

void describe(const std::vector<MergeMap>& maps, MergeResult& result) {
  result.reasons.assign(maps.size(), "");
  for (const MergedGroup& group : result.groups) {
    describeGroup(group, result.pairs);
    const std::size_t first = group.maps.front();
    if (group.maps.size() == 1) result.reasons[first] = islandReason(first, maps, result.pairs);
  }
}

}  // namespace semantic_mht_slam
