#pragma once

#include <memory>
#include <string>
#include <vector>

#include "semantic_mht_slam/app/system_config.h"
#include "semantic_mht_slam/merging/merge_map.h"

namespace semantic_mht_slam {

/// The maps that are merged, with all that they consist of.
struct MapInputs {
  SystemConfig config;     ///< effective
  SlamConfig slam_config;  ///< with paths that can be opened
  ClassTable classes;
  std::vector<std::unique_ptr<Slam>> estimators;  ///< of map files
  std::vector<std::unique_ptr<SlamParts>> landmark_maps;
  std::vector<MergeMap> maps;  ///< in the order of the files
};

/// Reads map files (.bag) and bare landmarks (text, a landmark a line: class x y z). The class table is that of the
/// configuration; where there are only bare landmarks and it does not know their classes, these are the classes. Throws
/// InputError.
MapInputs readMaps(const std::vector<std::string>& files, const std::string& config_file,
                   const std::vector<std::string>& settings);

}  // namespace semantic_mht_slam
