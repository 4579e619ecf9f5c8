#include "semantic_mht_slam/ros/object_extractor.h"

#include <utility>

#include <visualization_msgs/MarkerArray.h>

#include <semantic_mht_slam/SemanticObjectArray.h>

#include "semantic_mht_slam/bags/conversions.h"
#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/perception/cloud_extractor.h"
#include "semantic_mht_slam/perception/image_extractor.h"
#include "semantic_mht_slam/ros/markers.h"
#include "semantic_mht_slam/ros/sensor_conversions.h"

namespace semantic_mht_slam {
namespace {

constexpr std::uint32_t kObjectsQueue = 10;
constexpr double kWatchdogPeriod_s = 5.0;

/// Runs `convert`; what it throws is told with its topic.
template <class Convert>
auto onTopic(const std::string& topic, const Convert& convert) -> decltype(convert()) {
  try {
    return convert();
  } catch (const InputError& error) {
    throw InputError(topic + ": message skipped: " + error.what());
  }
}

}  // namespace

ObjectExtractor::ObjectExtractor(const ros::NodeHandle& handle, ObjectExtractorSetup setup)
    : handle_(handle),
      setup_(std::move(setup)),
      objects_publisher_(handle_.advertise<SemanticObjectArray>("objects", kObjectsQueue)),
      markers_publisher_(
          handle_.advertise<visualization_msgs::MarkerArray>("markers/extracted_objects", kObjectsQueue)) {
  if (setup_.config.source == LabelSource::kImage) {
    subscribeToImages();
  } else {
    cloud_subscriber_ = handle_.subscribe<sensor_msgs::PointCloud2>(
        "cloud", static_cast<std::uint32_t>(setup_.config.queue_size),
        [this](const sensor_msgs::PointCloud2ConstPtr& cloud) { extractFromCloud(*cloud); });
  }
}

void ObjectExtractor::subscribeToImages() {
  transform_listener_ = std::make_unique<tf2_ros::TransformListener>(transforms_);
  const auto queue = static_cast<std::uint32_t>(setup_.config.queue_size);
  Policy policy(queue);
  policy.setMaxIntervalDuration(ros::Duration(setup_.config.sync_slop_s));
  synchronizer_ = std::make_unique<message_filters::Synchronizer<Policy>>(std::as_const(policy), image_input_,
                                                                          info_input_, cloud_input_);
  synchronizer_->registerCallback(&ObjectExtractor::extractFromImage, this);
  image_input_.registerCallback(
      boost::function<void(const sensor_msgs::ImageConstPtr&)>([this](const auto&) { ++images_; }));
  info_input_.registerCallback(
      boost::function<void(const sensor_msgs::CameraInfoConstPtr&)>([this](const auto&) { ++infos_; }));
  cloud_input_.registerCallback(
      boost::function<void(const sensor_msgs::PointCloud2ConstPtr&)>([this](const auto&) { ++clouds_; }));
  image_input_.subscribe(handle_, "label_image", queue);
  info_input_.subscribe(handle_, "camera_info", queue);
  cloud_input_.subscribe(handle_, "cloud", queue);
  watchdog_ =
      handle_.createWallTimer(ros::WallDuration(kWatchdogPeriod_s), &ObjectExtractor::warnIfNothingMatches, this);
}

void ObjectExtractor::warnIfNothingMatches(const ros::WallTimerEvent&) {
  if (images_ + infos_ + clouds_ > 0 && matches_ == 0) {
    warnings_.warn("nothing to extract from: " + std::to_string(images_) + " messages on " + image_input_.getTopic() +
                   ", " + std::to_string(infos_) + " on " + info_input_.getTopic() + " and " + std::to_string(clouds_) +
                   " on " + cloud_input_.getTopic() + ", and no three whose stamps are within sync_slop");
  }
  images_ = infos_ = clouds_ = matches_ = 0;
}

void ObjectExtractor::extractFromCloud(const sensor_msgs::PointCloud2& cloud) {
  const std::string topic = cloud_subscriber_.getTopic();
  try {
    const LabelledCloud labelled = fromMessage(cloud, setup_.config.label_field);
    publish(cloud.header, extractObjects(labelled, setup_.labelled.labels, setup_.config.extraction), topic);
  } catch (const InputError& error) {
    warnings_.warn(topic + ": message skipped: " + error.what());
  }
}

void ObjectExtractor::extractFromImage(const sensor_msgs::ImageConstPtr& image,
                                       const sensor_msgs::CameraInfoConstPtr& info,
                                       const sensor_msgs::PointCloud2ConstPtr& cloud) {
  ++matches_;
  try {
    extractChecked(*image, *info, *cloud);
  } catch (const InputError& error) {
    warnings_.warn(error.what());
  }
}

void ObjectExtractor::extractChecked(const sensor_msgs::Image& image, const sensor_msgs::CameraInfo& info,
                                     const sensor_msgs::PointCloud2& cloud) {
  const std::string& image_topic = image_input_.getTopic();
  const std::string& info_topic = info_input_.getTopic();
  const LabelImage labels = onTopic(image_topic, [&] { return fromMessage(image); });
  const LabelledCloud points = onTopic(cloud_input_.getTopic(), [&] { return fromMessage(cloud, ""); });
  if (info.width != 0 && (info.width != image.width || info.height != image.height)) {
    throw InputError(info_topic + ": message skipped: width and height are not those of " + image_topic);
  }
  if (!transforms_.canTransform(info.header.frame_id, cloud.header.frame_id, ros::Time(0))) {
    throw InputError(cloud_input_.getTopic() + ": message skipped: no transform from '" + cloud.header.frame_id +
                     "' to '" + info.header.frame_id + "' (field 'header.frame_id')");
  }
  const Pose T_camera_cloud =
      fromMessage(transforms_.lookupTransform(info.header.frame_id, cloud.header.frame_id, ros::Time(0)).transform);
  const Camera camera = onTopic(info_topic, [&] { return fromMessage(info, T_camera_cloud); });
  publish(cloud.header, extractObjects(points, labels, camera, setup_.labelled.labels, setup_.config.extraction),
          image_topic);
}

void ObjectExtractor::publish(const std_msgs::Header& header, const Extraction& extraction,
                              const std::string& label_topic) {
  const bool is_cloud = setup_.config.source == LabelSource::kCloud;
  const std::string unknown = extraction.describeUnknownLabels(is_cloud ? "points" : "pixels");
  if (!unknown.empty()) {
    const std::string field = is_cloud ? setup_.config.label_field : "data";
    warnings_.warn(label_topic + " unknown labels", label_topic + ": field '" + field + "': skipped " + unknown);
  }
  if (extraction.points_not_finite > 0) {
    warnings_.warn((is_cloud ? label_topic : cloud_input_.getTopic()) + ": fields 'x', 'y', 'z': skipped " +
                   std::to_string(extraction.points_not_finite) + " points that are not finite");
  }
  SemanticObjectArray message =
      toMessage(toStamp(header.stamp), header.frame_id, extraction.detections(), setup_.labelled.classes);
  message.header = header;
  objects_publisher_.publish(message);
  if (markers_publisher_.getNumSubscribers() > 0) {
    markers_publisher_.publish(toBoxMarkers(extraction.objects, setup_.labelled.classes, header));
  }
}

}  // namespace semantic_mht_slam
