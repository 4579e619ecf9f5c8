#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "semantic_mht_slam/common/config.h"
#include "semantic_mht_slam/models/label_image.h"

namespace semantic_mht_slam {

/// Pixels of an image of 8 bit a channel that somebody else owns.
struct ImageView {
  int width_px = 0;
  int height_px = 0;
  int channels = 3;          ///< 1, 3 or 4; a fourth is ignored
  bool is_red_first = true;  ///< order of the colours
  std::size_t row_bytes = 0;
  const std::uint8_t* data = nullptr;
};

/// What a network wants its input to be.
struct SegmentationConfig {
  std::string model;        ///< ONNX file
  int input_width_px = 0;   ///< 0: the image's
  int input_height_px = 0;  ///< 0: the image's
  bool is_red_first = true;
  double mean_red = 0.0;  ///< subtracted from 0 to 255
  double mean_green = 0.0;
  double mean_blue = 0.0;
  double scale = 1.0 / 255.0;  ///< multiplied after that
  double stddev_red = 1.0;     ///< by which the channel is divided after that
  double stddev_green = 1.0;
  double stddev_blue = 1.0;
};

void describe(SegmentationConfig& config, Fields& fields);

/// A semantic segmentation network (ONNX, run by OpenCV on the processor). Its input is one image, 1x3xHxW; its output
/// either a score a class, 1xCxhxw, of which the best counts, or the ids themselves, 1xhxw or 1x1xhxw.
class SegmentationNetwork {
 public:
  /// Throws InputError naming the file if it is missing or OpenCV cannot read it.
  explicit SegmentationNetwork(const SegmentationConfig& config);
  ~SegmentationNetwork();
  SegmentationNetwork(SegmentationNetwork&&) noexcept;
  SegmentationNetwork& operator=(SegmentationNetwork&&) noexcept;

  /// Class ids of the network for each pixel of the image. Throws InputError if the network does not take the image or
  /// its output has another shape, std::invalid_argument for an image without pixels or of other channels.
  LabelImage segment(const ImageView& image);

 private:
  struct Network;

  SegmentationConfig config_;
  std::unique_ptr<Network> network_;
};

}  // namespace semantic_mht_slam
