#pragma once

#include <functional>
#include <memory>
#include <string>

#include "semantic_mht_slam/app/system_config.h"
#include "semantic_mht_slam/common/state_archive.h"
#include "semantic_mht_slam/slam/slam.h"

namespace semantic_mht_slam {

/// A map file as others are merged with it: what was still open when it was saved is ended. `slam_config`: with paths
/// that can be opened; `tell` is called if it is made of what another version of the program wrote. Throws InputError
/// as `readMapFile` does.
std::unique_ptr<Slam> readFinishedMap(const std::string& path, const SystemConfig& config,
                                      const SlamConfig& slam_config, const ClassTable& classes,
                                      const KeepReading& keep_reading,
                                      const std::function<void(const std::string& remark)>& tell);

}  // namespace semantic_mht_slam
