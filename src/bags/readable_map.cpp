#include "semantic_mht_slam/bags/readable_map.h"

#include <utility>

#include <rosbag/view.h>

#include "semantic_mht_slam/bags/map_update_conversions.h"
#include "semantic_mht_slam/common/error.h"

namespace semantic_mht_slam {
namespace {

/// Bytes that a map takes which a message describes, about.
std::uint64_t memoryFor(const MapUpdate& update, const ClassTable& classes) {
  const std::uint64_t landmark =
      sizeof(MixtureLandmark) + sizeof(MixtureComponent) + static_cast<std::uint64_t>(classes.size()) * sizeof(double);
  constexpr std::uint64_t kNode = 2048;  // a keyframe's part of the pose graph
  std::uint64_t bytes = update.landmarks.size() * landmark + (1 + update.keyframes.size()) * (sizeof(Keyframe) + kNode);
  bytes += 2 * sizeof(LandmarkId) * (update.duplicates.size() + update.pairs.size());
  bytes += update.closures.size() * sizeof(LoopClosureRecord);
  for (const MapUpdateClosure& closure : update.closures) bytes += closure.pairs.size() * sizeof(SameLandmark);
  return bytes + shownObjects(update) * (sizeof(SceneObject) + sizeof(DetectionAssociation));
}

}  // namespace

MapByDeltas readUpdates(const rosbag::Bag& bag, const ClassTable& classes, std::uint64_t most_memory,
                        const KeepReading& keep_reading) {
  MapByDeltas map;
  std::uint64_t left = most_memory;
  std::size_t closures = 0;
  rosbag::View view(bag, rosbag::TopicQuery(std::vector<std::string>{kUpdateTopic}));
  for (const rosbag::MessageInstance& instance : view) {
    if (!keep_reading()) throw InputError("reading was given up");
    const auto update = instance.instantiate<MapUpdate>();
    if (update == nullptr) throw InputError(std::string("topic ") + kUpdateTopic + " holds " + instance.getDataType());
    if (update->number != map.deltas.size()) throw InputError("map_update: field 'number': submaps out of order");
    const std::uint64_t needed = memoryFor(*update, classes);
    if (needed > left) throw InputError("map_update: more content than there can be");
    left -= needed;
    map.deltas.push_back(fromMessage(*update, classes));
    map.range_factor = update->range_factor;
    map.held = heldClosures(*update);
    closures += update->closures.size();
  }
  if (map.held.size() / 8 != (closures + 7) / 8)
    throw InputError("map_update: field 'closures_held': not of all closures");
  return map;
}

std::string describeRemade(const LoadedMap& map) {
  return map.state.source + ": " + map.remade +
         "; its finished submaps are used; what was open or learned, corrections by hand, sizes and fixes are not";
}

SlamState stateOf(LoadedMap map, const SlamConfig& config, const ClassTable& classes) {
  if (map.remade.empty()) return std::move(map.state);
  try {
    SlamState state = makeState(map.finished, config, classes);
    state.source = map.state.source;
    return state;
  } catch (const InputError& error) {
    throw InputError(map.state.source + ": " + map.remade + ": " + error.what());
  }
}

}  // namespace semantic_mht_slam
