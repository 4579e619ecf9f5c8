#pragma once

#include <string>
#include <vector>

#include "semantic_mht_slam/app/system_config.h"

namespace semantic_mht_slam {

/// Parameters of the map server itself.
struct MapServerConfig {
  std::string maps;
  std::string folder;
  std::string robots;
  std::string world_frame = "world";
};

void describe(MapServerConfig& config, Fields& fields);

/// All parameters of a map server: its own, and those that its maps were made with.
struct MapServerSetup {
  MapServerConfig server;
  SystemConfig system;
};

/// Keys that begin with `server.` are the server's own. Throws ConfigError.
MapServerSetup makeMapServerSetup(const std::vector<Setting>& settings);

}  // namespace semantic_mht_slam
