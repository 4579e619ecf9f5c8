#include "semantic_mht_slam/merging/joined_map.h"
#include "semantic_mht_slam/slam/map_uncertainty.h"
#include "semantic_mht_slam/slam/surroundings.h"

namespace semantic_mht_slam {

std::vector<MixtureLandmark> landmarksOf(const JoinedMap& joined) {
  const SlamParts& parts = joined.parts;
  const SlamParts& first = joined.members.front().map->parts();
  const double scale_stddev =
      first.mapper ? first.mapper->scaleStddev() : first.odometry.systematic.scale_translation.stddev;
  const MapGauge gauge{parts.start_cov, scale_stddev};
  return landmarksOf(parts.map, parts.graph, uncertaintyOf(parts.map, parts.graph, gauge));
}

std::vector<std::vector<StampedPose>> cutByMember(const JoinedMap& joined, const std::vector<StampedPose>& trajectory) {
  std::vector<std::vector<StampedPose>> result;
  auto begin = trajectory.begin();
  for (const JoinedMember& member : joined.members) {
    const auto count = member.map->parts().sessions.record(member.map->map()).odometry.size();
    const auto end = begin + static_cast<std::ptrdiff_t>(count);
    result.emplace_back(begin, end);
    begin = end;
  }
  return result;
}

}  // namespace semantic_mht_slam
