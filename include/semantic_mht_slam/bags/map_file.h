#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "semantic_mht_slam/app/system_config.h"
#include "semantic_mht_slam/common/stamped_pose.h"
#include "semantic_mht_slam/common/state_archive.h"
#include "semantic_mht_slam/map/landmark.h"
#include "semantic_mht_slam/models/class_table.h"
#include "semantic_mht_slam/slam/map_delta.h"
#include "semantic_mht_slam/slam/slam.h"

namespace semantic_mht_slam {

/// What goes into a map file: the state to go on from, and what others may want to read of it.
struct SavedMap {
  SlamState state;
  std::vector<MixtureLandmark> landmarks;  ///< map frame, by rising id
  std::vector<StampedPose> trajectory;     ///< T_map_base
  std::size_t submaps = 0;                 ///< finished ones
};

/// The same of an estimator, which may change from the moment on when `on_copied` is called: the trajectory is put
/// together after that.
SavedMap mapOf(
    const Slam& slam, const std::function<void()>& on_copied = [] {});

/// Writes a map as a bag with the topics /map_header, /map_section, /map_update, /map and /trajectory
/// (docs/map_files.md). The file
/// appears under its name when it is complete and on the disk (`OutputFile`). Returns its size in bytes. Throws
/// InputError, also where a file is in the way that is no map.
std::size_t writeMapFile(const std::string& path, const SavedMap& map, const SystemConfig& config,
                         const ClassTable& classes);

/// What was read of a map file.
struct LoadedMap {
  SlamState state;
  std::size_t submaps = 0;
  std::size_t landmarks = 0;
  bool has_same_parameters = true;  ///< of the estimator
  std::string remade;               ///< why the state cannot be used, but what is finished can; empty if it can
  MapByDeltas finished;             ///< what is finished, if so
};

/// Reads a map file. Throws InputError that names the file and the reason: no such file, truncated or no bag, no map
/// file, made by a newer program, broken, for another class table or another method, or given up. See `stateOf` in
/// readable_map.h for how to go on from it.
LoadedMap readMapFile(const std::string& path, const SystemConfig& config, const ClassTable& classes,
                      const KeepReading& keep_reading);

}  // namespace semantic_mht_slam
