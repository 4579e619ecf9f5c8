#pragma once

#include <ros/node_handle.h>
#include <sensor_msgs/Image.h>

#include "semantic_mht_slam/app/labelled_classes.h"
#include "semantic_mht_slam/app/object_extractor_config.h"
#include "semantic_mht_slam/perception/segmentation_network.h"
#include "semantic_mht_slam/ros/throttled_warnings.h"

namespace semantic_mht_slam {

/// Images on `image` to class ids on `label_image` (mono8, or 16UC1 if an id is above 255) and to a picture in the
/// colours of the class table on `label_preview` (rgb8), both with the header of the image. What the label map ignores
/// or lacks is black. Bad messages are skipped with a throttled warning that names topic and field.
class Segmentation {
 public:
  /// Throws InputError for a network that cannot be read.
  Segmentation(const ros::NodeHandle& handle, const SegmentationNodeConfig& config);

  Segmentation(const Segmentation&) = delete;
  Segmentation& operator=(const Segmentation&) = delete;

 private:
  void segment(const sensor_msgs::Image& image);

  ros::NodeHandle handle_;
  const LabelledClasses labelled_;
  SegmentationNetwork network_;
  ThrottledWarnings warnings_;
  ros::Publisher labels_publisher_;
  ros::Publisher preview_publisher_;
  ros::Subscriber image_subscriber_;
};

/// Class ids as a message, mono8 or, if one is above 255, 16UC1.
sensor_msgs::Image toMessage(const std_msgs::Header& header, const LabelImage& labels);

/// Class ids in the colours of their classes, rgb8.
sensor_msgs::Image toPreview(const std_msgs::Header& header, const LabelImage& labels, const LabelledClasses& labelled);

}  // namespace semantic_mht_slam
