#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace semantic_mht_slam {

/// Points of one scan and what a segmentation says each of them is. Both lists have the same length.
struct LabelledCloud {
  std::vector<Eigen::Vector3f> points_m;  ///< in the sensor frame; need not be finite
  std::vector<std::uint16_t> labels;      ///< raw ids of the segmentation, see LabelMap

  std::size_t size() const { return points_m.size(); }

  void reserve(std::size_t points) {
    points_m.reserve(points);
    labels.reserve(points);
  }
};

}  // namespace semantic_mht_slam
