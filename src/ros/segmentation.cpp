#include "semantic_mht_slam/ros/segmentation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include <sensor_msgs/image_encodings.h>

#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/ros/sensor_conversions.h"

namespace semantic_mht_slam {
namespace {

constexpr std::uint32_t kImageQueue = 2;

sensor_msgs::Image blankMessage(const std_msgs::Header& header, const LabelImage& labels, const std::string& encoding,
                                std::uint32_t bytes_per_pixel) {
  sensor_msgs::Image message;
  message.header = header;
  message.width = static_cast<std::uint32_t>(labels.width_px);
  message.height = static_cast<std::uint32_t>(labels.height_px);
  message.encoding = encoding;
  message.is_bigendian = 0;
  message.step = message.width * bytes_per_pixel;
  message.data.resize(std::size_t{message.step} * message.height);
  return message;
}

}  // namespace

sensor_msgs::Image toMessage(const std_msgs::Header& header, const LabelImage& labels) {
  namespace encodings = sensor_msgs::image_encodings;
  const auto is_large = [](std::uint16_t id) { return id > 255; };
  if (std::any_of(labels.labels.begin(), labels.labels.end(), is_large)) {
    sensor_msgs::Image message = blankMessage(header, labels, encodings::TYPE_16UC1, 2);
    std::memcpy(message.data.data(), labels.labels.data(), message.data.size());
    return message;
  }
  sensor_msgs::Image message = blankMessage(header, labels, encodings::MONO8, 1);
  std::transform(labels.labels.begin(), labels.labels.end(), message.data.begin(),
                 [](std::uint16_t id) { return static_cast<std::uint8_t>(id); });
  return message;
}

sensor_msgs::Image toPreview(const std_msgs::Header& header, const LabelImage& labels,
                             const LabelledClasses& labelled) {
  std::vector<std::array<std::uint8_t, 3>> colors;
  for (const ClassInfo& info : labelled.classes.all()) {
    const std::array<double, 3> rgb = info.rgb();
    const auto byte = [](double share) { return static_cast<std::uint8_t>(std::lround(255.0 * share)); };
    colors.push_back({byte(rgb[0]), byte(rgb[1]), byte(rgb[2])});
  }
  sensor_msgs::Image message = blankMessage(header, labels, sensor_msgs::image_encodings::RGB8, 3);
  for (std::size_t i = 0; i < labels.labels.size(); ++i) {
    const ClassIndex class_index = labelled.labels.classOf(labels.labels[i]);
    if (class_index < 0) continue;
    std::copy_n(colors[static_cast<std::size_t>(class_index)].begin(), 3,
                message.data.begin() + 3 * static_cast<std::ptrdiff_t>(i));
  }
  return message;
}

Segmentation::Segmentation(const ros::NodeHandle& handle, const SegmentationNodeConfig& config)
    : handle_(handle),
      labelled_(loadLabelledClasses(config.label_map)),
      network_(config.network),
      labels_publisher_(handle_.advertise<sensor_msgs::Image>("label_image", kImageQueue)),
      preview_publisher_(handle_.advertise<sensor_msgs::Image>("label_preview", kImageQueue)) {
  image_subscriber_ =
      handle_.subscribe<sensor_msgs::Image>("image", static_cast<std::uint32_t>(config.queue_size),
                                            [this](const sensor_msgs::ImageConstPtr& image) { segment(*image); });
}

void Segmentation::segment(const sensor_msgs::Image& image) {
  try {
    const LabelImage labels = network_.segment(viewOf(image));
    labels_publisher_.publish(toMessage(image.header, labels));
    if (preview_publisher_.getNumSubscribers() > 0) {
      preview_publisher_.publish(toPreview(image.header, labels, labelled_));
    }
  } catch (const InputError& error) {
    warnings_.warn(image_subscriber_.getTopic() + ": message skipped: " + error.what());
  }
}

}  // namespace semantic_mht_slam
