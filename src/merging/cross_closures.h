#pragma once

#include <set>
#include <vector>

#include "semantic_mht_slam/merging/joined_map.h"
#include "semantic_mht_slam/merging/overlap.h"

namespace semantic_mht_slam {

/// Lays what keyframes of b see onto a, the nearest to an anchor first; every find is another anchor. Those of `known`
/// are left out. Closures that passed every check of a revisit, by rising query.
std::vector<LoopClosureRecord> closuresBetween(const MergeMap& a, const MergeMap& b, std::vector<OverlapAnchor> anchors,
                                               const std::set<KeyframeId>& known, const MergeSettings& settings);

/// Where the keyframes of one member should see another one, by the poses of a joined map; `stddev_m` is what these may
/// be off by.
std::vector<OverlapAnchor> anchorsIn(const JoinedMap& joined, const JoinedMember& a, const JoinedMember& b,
                                     double stddev_m, double radius_m);

/// T_a_b of the two map frames on which the closures (query in b, at least one) agree best.
Pose middleOf(const MergeMap& a, const MergeMap& b, const std::vector<LoopClosureRecord>& records);

}  // namespace semantic_mht_slam
