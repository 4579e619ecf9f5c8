#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include <message_filters/subscriber.h>
#include <message_filters/sync_policies/approximate_time.h>
#include <message_filters/synchronizer.h>
#include <ros/node_handle.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/PointCloud2.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include "semantic_mht_slam/app/object_extractor_config.h"
#include "semantic_mht_slam/perception/extracted_object.h"
#include "semantic_mht_slam/ros/throttled_warnings.h"

namespace semantic_mht_slam {

/// Labelled clouds on `cloud`, or label images on `label_image` with `camera_info` and `cloud`, to `objects`
/// (SemanticObjectArray with stamp and frame of the cloud) and boxes in class colours on `markers/extracted_objects`.
/// The body of the node and of the nodelet. Bad messages are skipped with a throttled warning that names topic and
/// field.
class ObjectExtractor {
 public:
  ObjectExtractor(const ros::NodeHandle& handle, ObjectExtractorSetup setup);

  ObjectExtractor(const ObjectExtractor&) = delete;
  ObjectExtractor& operator=(const ObjectExtractor&) = delete;

 private:
  using Policy = message_filters::sync_policies::ApproximateTime<sensor_msgs::Image, sensor_msgs::CameraInfo,
                                                                 sensor_msgs::PointCloud2>;

  void extractFromCloud(const sensor_msgs::PointCloud2& cloud);
  void extractFromImage(const sensor_msgs::ImageConstPtr& image, const sensor_msgs::CameraInfoConstPtr& info,
                        const sensor_msgs::PointCloud2ConstPtr& cloud);
  void extractChecked(const sensor_msgs::Image& image, const sensor_msgs::CameraInfo& info,
                      const sensor_msgs::PointCloud2& cloud);
  void publish(const std_msgs::Header& header, const Extraction& extraction, const std::string& label_topic);
  void subscribeToImages();
  void warnIfNothingMatches(const ros::WallTimerEvent& event);

  ros::NodeHandle handle_;
  const ObjectExtractorSetup setup_;
  tf2_ros::Buffer transforms_;
  std::unique_ptr<tf2_ros::TransformListener> transform_listener_;
  ThrottledWarnings warnings_;
  ros::Publisher objects_publisher_;
  ros::Publisher markers_publisher_;
  ros::Subscriber cloud_subscriber_;
  message_filters::Subscriber<sensor_msgs::Image> image_input_;
  message_filters::Subscriber<sensor_msgs::CameraInfo> info_input_;
  message_filters::Subscriber<sensor_msgs::PointCloud2> cloud_input_;
  std::unique_ptr<message_filters::Synchronizer<Policy>> synchronizer_;
  ros::WallTimer watchdog_;
  std::size_t images_ = 0;  ///< since the watchdog looked
  std::size_t infos_ = 0;
  std::size_t clouds_ = 0;
  std::size_t matches_ = 0;
};

}  // namespace semantic_mht_slam
