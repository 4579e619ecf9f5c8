#include "semantic_mht_slam/perception/segmentation_network.h"

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <system_error>

#include <opencv2/core.hpp>
#include <opencv2/dnn.hpp>
#include <opencv2/imgproc.hpp>

#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/models/label_map.h"

namespace semantic_mht_slam {
namespace {

std::string shapeOf(const cv::Mat& blob) {
  std::string text;
  for (int i = 0; i < blob.dims; ++i) text += (i > 0 ? "x" : "") + std::to_string(blob.size[i]);
  return text;
}

/// The image with three channels in the order of the network.
cv::Mat toColor(const ImageView& image, bool is_red_first) {
  if (image.data == nullptr || image.width_px <= 0 || image.height_px <= 0) {
    throw std::invalid_argument("segment: an image without pixels");
  }
  if (image.channels != 1 && image.channels != 3 && image.channels != 4) {
    throw std::invalid_argument("segment: an image of " + std::to_string(image.channels) + " channels");
  }
  const cv::Mat pixels(image.height_px, image.width_px, CV_8UC(image.channels), const_cast<std::uint8_t*>(image.data),
                       image.row_bytes);
  const bool is_swapped = image.is_red_first != is_red_first;
  cv::Mat color;
  if (image.channels == 1) {
    cv::cvtColor(pixels, color, cv::COLOR_GRAY2BGR);
  } else if (image.channels == 4) {
    cv::cvtColor(pixels, color, is_swapped ? cv::COLOR_RGBA2BGR : cv::COLOR_RGBA2RGB);
  } else if (is_swapped) {
    cv::cvtColor(pixels, color, cv::COLOR_RGB2BGR);
  } else {
    color = pixels;
  }
  return color;
}

/// Values of the channels in the order of the network.
cv::Scalar inOrder(double red, double green, double blue, bool is_red_first) {
  return is_red_first ? cv::Scalar(red, green, blue) : cv::Scalar(blue, green, red);
}

/// Ids of an output of 1xCxhxw scores: the first of the best classes.
cv::Mat1w bestClasses(const cv::Mat& scores) {
  const int classes = scores.size[1];
  const int height = scores.size[2];
  const int width = scores.size[3];
  cv::Mat1f best(height, width, const_cast<float*>(scores.ptr<float>(0, 0)));
  best = best.clone();
  cv::Mat1w ids(height, width, static_cast<std::uint16_t>(0));
  for (int c = 1; c < classes; ++c) {
    const cv::Mat1f score(height, width, const_cast<float*>(scores.ptr<float>(0, c)));
    const cv::Mat is_better = score > best;
    ids.setTo(c, is_better);
    score.copyTo(best, is_better);
  }
  return ids;
}

cv::Mat1w toIds(const cv::Mat& output, const std::string& model) {
  const bool has_scores = output.dims == 4 && output.size[0] == 1 && output.size[1] > 1;
  const bool has_ids = (output.dims == 3 || (output.dims == 4 && output.size[1] == 1)) && output.size[0] == 1;
  if (output.type() != CV_32F || output.total() == 0 || !(has_scores || has_ids) ||
      (has_scores && output.size[1] > LabelMap::kMaxId + 1)) {
    throw InputError(model + ": the network's output is " + shapeOf(output) + ", expected is 1 x classes x rows x " +
                     "columns, or 1 x rows x columns of class ids");
  }
  if (has_scores) return bestClasses(output);
  cv::Mat1w ids;
  const cv::Mat1f values(output.size[output.dims - 2], output.size[output.dims - 1],
                         const_cast<float*>(output.ptr<float>()));
  values.convertTo(ids, CV_16U);
  return ids;
}

}  // namespace

struct SegmentationNetwork::Network {
  cv::dnn::Net net;
};

void describe(SegmentationConfig& config, Fields& fields) {
  fields.add("model", config.model, "ONNX file of the segmentation network.");
  fields.add("input_width", config.input_width_px, "px", {0, 16384}, "Width that the network wants; 0: the image's.");
  fields.add("input_height", config.input_height_px, "px", {0, 16384},
             "Height that the network wants; 0: the image's.");
  fields.add("red_first", config.is_red_first, "Whether the network wants red, green, blue rather than the reverse.");
  fields.add("mean_red", config.mean_red, "", {0.0, 255.0}, "Subtracted from the red channel, which is 0 to 255.");
  fields.add("mean_green", config.mean_green, "", {0.0, 255.0}, "Subtracted from the green channel.");
  fields.add("mean_blue", config.mean_blue, "", {0.0, 255.0}, "Subtracted from the blue channel.");
  fields.add("scale", config.scale, "", {1e-9, 1e3}, "Multiplied with the channels after that.");
  fields.add("stddev_red", config.stddev_red, "", {1e-6, 1e6}, "The red channel is divided by this after that.");
  fields.add("stddev_green", config.stddev_green, "", {1e-6, 1e6}, "The same for the green channel.");
  fields.add("stddev_blue", config.stddev_blue, "", {1e-6, 1e6}, "The same for the blue channel.");
}

SegmentationNetwork::SegmentationNetwork(const SegmentationConfig& config)
    : config_(config), network_(std::make_unique<Network>()) {
  std::error_code look_error;
  if (!std::filesystem::is_regular_file(config.model, look_error)) {
    throw InputError("cannot read the network '" + config.model + "': no such file" +
                     (look_error ? " (" + look_error.message() + ")" : ""));
  }
  try {
    network_->net = cv::dnn::readNetFromONNX(config.model);
  } catch (const cv::Exception& error) {
    throw InputError(config.model + ": OpenCV cannot read the network: " + error.err);
  }
  if (network_->net.empty()) throw InputError(config.model + ": holds no network");
  network_->net.setPreferableBackend(cv::dnn::DNN_BACKEND_OPENCV);
  network_->net.setPreferableTarget(cv::dnn::DNN_TARGET_CPU);
}

SegmentationNetwork::~SegmentationNetwork() = default;
SegmentationNetwork::SegmentationNetwork(SegmentationNetwork&&) noexcept = default;
SegmentationNetwork& SegmentationNetwork::operator=(SegmentationNetwork&&) noexcept = default;

LabelImage SegmentationNetwork::segment(const ImageView& image) {
  const cv::Mat color = toColor(image, config_.is_red_first);
  const cv::Size size(config_.input_width_px > 0 ? config_.input_width_px : image.width_px,
                      config_.input_height_px > 0 ? config_.input_height_px : image.height_px);
  const cv::Scalar mean = inOrder(config_.mean_red, config_.mean_green, config_.mean_blue, config_.is_red_first);
  const cv::Scalar stddev =
      inOrder(config_.stddev_red, config_.stddev_green, config_.stddev_blue, config_.is_red_first);
  cv::Mat output;
  try {
    constexpr bool kSwap = false;
    constexpr bool kCrop = false;
    cv::Mat blob = cv::dnn::blobFromImage(color, config_.scale, size, mean, kSwap, kCrop, CV_32F);
    for (int c = 0; c < 3; ++c) {
      cv::Mat1f channel(size.height, size.width, blob.ptr<float>(0, c));
      channel /= stddev[c];
    }
    network_->net.setInput(blob);
    output = network_->net.forward();
  } catch (const cv::Exception& error) {
    throw InputError(config_.model + ": the network cannot be run on an image of " + std::to_string(size.width) + "x" +
                     std::to_string(size.height) + " px: " + error.err);
  }
  cv::Mat1w ids;
  cv::resize(toIds(output, config_.model), ids, {image.width_px, image.height_px}, 0.0, 0.0, cv::INTER_NEAREST);
  LabelImage labels{image.width_px, image.height_px, {}};
  labels.labels.assign(ids.begin(), ids.end());
  return labels;
}

}  // namespace semantic_mht_slam
