#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <std_msgs/Time.h>
#include <tf2/buffer_core.h>
#include <tf2_msgs/TFMessage.h>

#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/ros/bag_file.h"
#include "semantic_mht_slam/ros/conversions.h"

namespace semantic_mht_slam {
namespace {

/// Reads the messages of a bag into a recording; each `add` takes one kind.
class BagReader {
 public:
  BagReader(const std::string& path, const ClassTable& classes, const NodeConfig& frames, const BagLayout& layout)
      : path_(path), classes_(classes), frames_(frames), layout_(layout) {}

  Recording read() {
    try {
      rosbag::Bag bag(path_, rosbag::bagmode::Read);
      collect(bag, {"/tf_static"}, &BagReader::addStaticTransforms);
      collect(bag, {layout_.time_origin_topic}, &BagReader::addTimeOrigin);
      collect(bag, {layout_.ground_truth_topic}, &BagReader::addGroundTruth);
      collect(bag, {layout_.odometry_topic}, &BagReader::addOdometry);
      collect(bag, {layout_.objects_topic}, &BagReader::addObjects);
    } catch (const rosbag::BagUnindexedException&) {
      throw InputError(path_ + ": the bag has no index: it is truncated or was not closed (rosbag reindex may help)");
    } catch (const rosbag::BagException& error) {
      throw InputError(path_ + ": truncated, or no bag at all: " + error.what());
    } catch (const ros::Exception& error) {
      throw InputError(path_ + ": broken message: " + error.what());
    }
    require(!recording_.odometry.empty(), "no messages on " + layout_.odometry_topic);
    require(!recording_.detector_frames.empty(), "no messages on " + layout_.objects_topic);
    recording_.T_base_cam0 = findTransform(frames_.base_frame, layout_.camera_frame);
    return std::move(recording_);
  }

 private:
  using Add = void (BagReader::*)(const rosbag::MessageInstance&);

  void collect(const rosbag::Bag& bag, const std::vector<std::string>& topics, Add add) {
    rosbag::View view(bag, rosbag::TopicQuery(topics));
    for (const rosbag::MessageInstance& message : view) (this->*add)(message);
  }

  void require(bool condition, const std::string& problem) const {
    if (!condition) throw InputError(path_ + ": " + problem);
  }

  template <class Message>
  boost::shared_ptr<Message> instantiate(const rosbag::MessageInstance& instance) const {
    const auto message = instance.instantiate<Message>();
    require(message != nullptr, "topic " + instance.getTopic() + " holds " + instance.getDataType() + ", not " +
                                    ros::message_traits::datatype<Message>());
    return message;
  }

  void addStaticTransforms(const rosbag::MessageInstance& instance) {
    const auto message = instantiate<tf2_msgs::TFMessage>(instance);
    for (const auto& transform : message->transforms) {
      static_transforms_[{transform.header.frame_id, transform.child_frame_id}] = fromMessage(transform.transform);
      transforms_.setTransform(transform, "bag", true);
    }
  }

  void addTimeOrigin(const rosbag::MessageInstance& instance) {
    time_origin_ = toStamp(instantiate<std_msgs::Time>(instance)->data);
  }

  void addGroundTruth(const rosbag::MessageInstance& instance) {
    const auto message = instantiate<nav_msgs::Path>(instance);
    for (const auto& pose : message->poses) {
      recording_.ground_truth.push_back({toStamp(pose.header.stamp) - time_origin_, fromMessage(pose.pose)});
    }
  }

  void addOdometry(const rosbag::MessageInstance& instance) {
    const auto message = instantiate<nav_msgs::Odometry>(instance);
    require(message->header.frame_id == frames_.odom_frame && message->child_frame_id == frames_.base_frame,
            "topic " + layout_.odometry_topic + " is from '" + message->header.frame_id + "' to '" +
                message->child_frame_id + "', configured is '" + frames_.odom_frame + "' to '" + frames_.base_frame +
                "' (node.odom_frame, node.base_frame)");
    recording_.odometry.push_back({toStamp(message->header.stamp) - time_origin_, fromMessage(message->pose.pose)});
  }

  void addObjects(const rosbag::MessageInstance& instance) {
    const auto message = instantiate<SemanticObjectArray>(instance);
    const std::optional<Pose> T_base_sensor = findTransform(frames_.base_frame, message->header.frame_id);
    require(T_base_sensor.has_value(), "topic " + layout_.objects_topic + ": frame '" + message->header.frame_id +
                                           "' is not connected to '" + frames_.base_frame + "' by /tf_static");
    for (const SemanticObject& object : message->objects) {
      require(classes_.findId(object.class_id).has_value(),
              "topic " + layout_.objects_topic + ": class id " + std::to_string(object.class_id) +
                  " is not in the class table (" + classes_.names() + ")");
    }
    std::size_t unknown_classes = 0;
    recording_.detector_frames.push_back({toStamp(message->header.stamp) - time_origin_,
                                          fromMessage(*message, classes_, *T_base_sensor, unknown_classes)});
  }

  /// T_target_source. A transform that stands in the bag as such is taken to the last bit.
  std::optional<Pose> findTransform(const std::string& target, const std::string& source) const {
    if (target == source) return Pose::identity();
    const auto direct = static_transforms_.find({target, source});
    if (direct != static_transforms_.end()) return direct->second;
    if (!transforms_.canTransform(target, source, ros::Time(0))) return std::nullopt;
    return fromMessage(transforms_.lookupTransform(target, source, ros::Time(0)).transform);
  }

  const std::string& path_;
  const ClassTable& classes_;
  const NodeConfig& frames_;
  const BagLayout& layout_;
  Recording recording_;
  Stamp time_origin_ = 0;
  std::map<std::pair<std::string, std::string>, Pose> static_transforms_;
  tf2::BufferCore transforms_;
};

}  // namespace

Recording readBag(const std::string& path, const ClassTable& classes, const NodeConfig& frames,
                  const BagLayout& layout) {
  if (!std::filesystem::is_regular_file(path))
    throw InputError("cannot read '" + path + "': no such file, or no regular one");
  return BagReader(path, classes, frames, layout).read();
}

}  // namespace semantic_mht_slam
