#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace semantic_mht_slam {

/// What a segmentation says each pixel of an image is.
struct LabelImage {
  int width_px = 0;
  int height_px = 0;
  std::vector<std::uint16_t> labels;  ///< raw ids of the segmentation, row by row, width_px * height_px of them

  std::uint16_t at(int column, int row) const {
    return labels[static_cast<std::size_t>(row) * static_cast<std::size_t>(width_px) +
                  static_cast<std::size_t>(column)];
  }
};

}  // namespace semantic_mht_slam
