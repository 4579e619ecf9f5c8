#include "semantic_mht_slam/ros/starting_map.h"

#include <filesystem>

#include <ros/init.h>

#include "semantic_mht_slam/bags/map_file.h"
#include "semantic_mht_slam/bags/readable_map.h"
#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/ros/map_path.h"

namespace semantic_mht_slam {

std::unique_ptr<Slam> startingSlam(const SystemConfig& config, const ClassTable& classes) {
  const NodeConfig& node = config.node;
  const bool localizes = node.mode == StartMode::kLocalization;
  if (node.map.empty()) {
    if (localizes) throw InputError("node/mode is localization, and node/map names no map file to localize in");
    return std::make_unique<Slam>(config.slam, classes);
  }
  if (node.map.front() != '~' && node.map_folder.empty() && !std::filesystem::path(node.map).is_absolute()) {
    throw InputError("node/map: '" + node.map + "' is no absolute path (nodes do not run where roslaunch was called)");
  }
  const std::string path = mapPath(node.map, node.map_folder);
  LoadedMap map = readMapFile(path, config, classes, ros::ok);
  if (!map.remade.empty()) ROS_WARN("%s", describeRemade(map).c_str());
  auto slam = std::make_unique<Slam>(config.slam, classes, stateOf(std::move(map), config.slam, classes), ros::ok);
  if (localizes && slam->map().submaps().empty()) {
    throw InputError("node/map: '" + path + "' has no finished submap to localize in");
  }
  if (localizes) slam->localize();
  return slam;
}

}  // namespace semantic_mht_slam
