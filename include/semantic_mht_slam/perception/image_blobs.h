#pragma once

#include <vector>

#include "semantic_mht_slam/models/label_image.h"
#include "semantic_mht_slam/models/label_map.h"
#include "semantic_mht_slam/perception/extraction_config.h"

namespace semantic_mht_slam {

/// Connected regions of one class in a label image.
struct ImageBlobs {
  static constexpr int kNone = -1;

  int width_px = 0;
  std::vector<int> blob_of_pixel;           ///< row by row, kNone outside every blob
  std::vector<bool> is_rim;                 ///< by pixel: nearer to the edge of its blob than `border_px`
  std::vector<ClassIndex> class_of_blob;    ///< rising
  std::vector<std::size_t> unknown_pixels;  ///< by raw label id that the map lacks
};

/// Finds the blobs: per class the mask is closed, its 8-connected components of at least `min_pixels` are blobs. Pixels
/// that closing alone has added join components but belong to none. Throws std::invalid_argument unless the image has
/// one label a pixel, std::out_of_range if the map names a class beyond `classes`.
ImageBlobs findBlobs(const LabelImage& image, const LabelMap& labels, int classes, const ImageConfig& config);

}  // namespace semantic_mht_slam
