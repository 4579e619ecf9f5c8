#include "semantic_mht_slam/app/map_server_config.h"

namespace semantic_mht_slam {
namespace {

constexpr const char* kGroup = "server.";

}  // namespace

void describe(MapServerConfig& config, Fields& fields) {
  fields.add("server.maps", config.maps, "Map files to begin with, absolute, with `:` between them.");
  fields.add("server.folder", config.folder,
             "Folder whose map files (*.bag) are taken as they come and change; absolute. Empty: none.");
  fields.add("server.robots", config.robots,
             "Namespaces of the nodes of robots whose maps are taken as they grow, with `:` between them.");
  fields.add("server.world_frame", config.world_frame, "Frame of the joined map; that of the first map in it.");
}

MapServerSetup makeMapServerSetup(const std::vector<Setting>& settings) {
  MapServerSetup setup;
  std::vector<Setting> own;
  std::vector<Setting> others;
  for (const Setting& setting : settings) (setting.key.rfind(kGroup, 0) == 0 ? own : others).push_back(setting);
  Fields fields;
  describe(setup.server, fields);
  applySettings(own, fields);
  setup.system = makeSystemConfig(others);
  return setup;
}

}  // namespace semantic_mht_slam
