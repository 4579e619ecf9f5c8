#include "semantic_mht_slam/bags/finished_map.h"

#include <utility>

#include "semantic_mht_slam/bags/map_file.h"
#include "semantic_mht_slam/bags/readable_map.h"

namespace semantic_mht_slam {

std::unique_ptr<Slam> readFinishedMap(const std::string& path, const SystemConfig& config,
                                      const SlamConfig& slam_config, const ClassTable& classes,
                                      const KeepReading& keep_reading,
                                      const std::function<void(const std::string& remark)>& tell) {
  LoadedMap map = readMapFile(path, config, classes, keep_reading);
  if (!map.remade.empty()) tell(describeRemade(map));
  auto slam = std::make_unique<Slam>(slam_config, classes, stateOf(std::move(map), slam_config, classes), keep_reading);
  const SlamParts& parts = slam->parts();
  if (!parts.waiting.empty() || (parts.mapper && parts.mapper->isOpen())) slam->finish();
  return slam;
}

}  // namespace semantic_mht_slam
