#pragma once

#include <cstdint>
#include <string>

#include <rosbag/bag.h>

#include "semantic_mht_slam/bags/map_file.h"

namespace semantic_mht_slam {

/// Where a map file has what is finished of the map as messages (`MapUpdate`), which every later program can read.
constexpr const char* kUpdateTopic = "/map_update";

/// These messages. Throws InputError where there are none, one cannot be used, the map takes more than `most_memory`
/// bytes, or reading is given up.
MapByDeltas readUpdates(const rosbag::Bag& bag, const ClassTable& classes, std::uint64_t most_memory,
                        const KeepReading& keep_reading);

/// For a person: what of a map is used if another version of this program wrote its state.
std::string describeRemade(const LoadedMap& map);

/// What to go on from: the state as it was read, or if another version of this program wrote that, one that is made of
/// the finished submaps. Throws InputError where neither can be used.
SlamState stateOf(LoadedMap map, const SlamConfig& config, const ClassTable& classes);

}  // namespace semantic_mht_slam
