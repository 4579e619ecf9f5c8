#pragma once

#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string>

#include "semantic_mht_slam/common/random.h"
#include "semantic_mht_slam/models/labelled_cloud.h"

namespace semantic_mht_slam {

/// A folder of the data that SEMANTIC_MHT_SLAM_DATA names, for example "scans"; empty where there is none.
inline std::optional<std::string> dataFolder(const std::string& name) {
  const char* folder = std::getenv("SEMANTIC_MHT_SLAM_DATA");
  if (folder == nullptr || *folder == '\0') return std::nullopt;
  return std::string(folder) + "/" + name;
}

/// Adds points spread evenly over a box.
inline void addBox(LabelledCloud& cloud, const Eigen::Vector3d& center_m, const Eigen::Vector3d& size_m, int points,
                   std::uint16_t label, Rng& rng) {
  for (int i = 0; i < points; ++i) {
    const Eigen::Vector3d offset(rng.uniform(-0.5, 0.5), rng.uniform(-0.5, 0.5), rng.uniform(-0.5, 0.5));
    cloud.points_m.emplace_back((center_m + offset.cwiseProduct(size_m)).cast<float>());
    cloud.labels.push_back(label);
  }
}

}  // namespace semantic_mht_slam
