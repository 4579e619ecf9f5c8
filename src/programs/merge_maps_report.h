#pragma once

#include <string>
#include <vector>

#include "semantic_mht_slam/common/stamped_pose.h"
#include "semantic_mht_slam/merging/map_merger.h"

namespace semantic_mht_slam {

/// A member of the joined map as the files show it.
struct MemberResult {
  std::string name;
  std::vector<StampedPose> trajectory;  ///< T_joined_base; empty for bare landmarks
};

/// The report as JSON (docs/merging_maps.md). `seconds` is the time of comparing and joining.
std::string mergeReportJson(const MergeResult& result, const std::vector<MergeMap>& maps, std::size_t landmarks,
                            double seconds);

/// The same for people, with a drawing of the joined map.
std::string mergeReportHtml(const MergeResult& result, const std::vector<MergeMap>& maps,
                            const std::vector<MemberResult>& members, const std::vector<MixtureLandmark>& landmarks);

/// One line: what was joined, and what was not.
std::string mergeSummary(const MergeResult& result, const std::vector<MergeMap>& maps);

}  // namespace semantic_mht_slam
