#include <algorithm>
#include <limits>
#include <utility>

#include <console_bridge/console.h>
#include <rosbag/view.h>
#include <std_msgs/Time.h>
#include <tf2/buffer_core.h>
#include <tf2_msgs/TFMessage.h>

#include "semantic_mht_slam/bags/bag_file.h"
#include "semantic_mht_slam/bags/conversions.h"
#include "semantic_mht_slam/bags/fix_gate.h"
#include "semantic_mht_slam/bags/guarded_bag.h"
#include "semantic_mht_slam/bags/objects_gate.h"
#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/common/text.h"
#include "semantic_mht_slam/io/existing_path.h"

namespace semantic_mht_slam {
namespace {

constexpr const char* kFixes = "fix";

/// tf2 prints every transform that it leaves out, of which a recording may be full.
class QuietTf {
 public:
  QuietTf() : before_(console_bridge::getLogLevel()) {
    console_bridge::setLogLevel(console_bridge::CONSOLE_BRIDGE_LOG_NONE);
  }
  ~QuietTf() { console_bridge::setLogLevel(before_); }
  QuietTf(const QuietTf&) = delete;
  QuietTf& operator=(const QuietTf&) = delete;

 private:
  console_bridge::LogLevel before_;
};

/// Reads the messages of a bag into a recording, by the gates of the node.
class BagReader {
 public:
  BagReader(const std::string& path, const ClassTable& classes, const NodeConfig& frames, const BagLayout& layout)
      : path_(path),
        frames_(frames),
        layout_(layout),
        odometry_gate_(frames),
        sensors_(transforms_, frames),
        objects_gate_(frames, classes, sensors_, std::numeric_limits<std::size_t>::max()) {}

  Recording read() {
    const QuietTf quiet;
    try {
      GuardedBag bag(path_, rosbag::bagmode::Read);
      readBefore(*bag);
      readInput(*bag);
    } catch (const rosbag::BagUnindexedException&) {
      throw InputError(path_ + ": the bag has no index: it is truncated or was not closed (rosbag reindex may help)");
    } catch (const rosbag::BagException& error) {
      throw InputError(path_ + ": truncated, or no bag at all: " + error.what());
    } catch (const ros::Exception& error) {
      throw InputError(path_ + ": broken message: " + error.what());
    }
    return std::move(recording_);
  }

 private:
  /// What holds for the whole bag, wherever it stands.
  void readBefore(const rosbag::Bag& bag) {
    for (const rosbag::MessageInstance& instance : rosbag::View(bag, rosbag::TopicQuery("/tf_static"))) {
      addTransforms(instance, true);
    }
    forEachOf<std_msgs::Time>(bag, layout_.time_origin_topic,
                              [&](const std_msgs::Time& message) { time_origin_ = toStamp(message.data); });
    forEachOf<nav_msgs::Path>(bag, layout_.ground_truth_topic, [&](const nav_msgs::Path& message) {
      for (const auto& pose : message.poses) {
        recording_.ground_truth.push_back({toStamp(pose.header.stamp) - time_origin_, fromMessage(pose.pose)});
      }
    });
    if (transforms_.canTransform(frames_.base_frame, layout_.camera_frame, ros::Time(0))) {
      const auto found = transforms_.lookupTransform(frames_.base_frame, layout_.camera_frame, ros::Time(0));
      recording_.T_base_cam0 = fromMessage(found.transform);
    }
  }

  /// What the node would receive, in the order in which it was recorded.
  void readInput(const rosbag::Bag& bag) {
    recording_.names = {findTopic<nav_msgs::Odometry>(bag, layout_.odometry_topic),
                        findTopic<SemanticObjectArray>(bag, layout_.objects_topic), frames_.base_frame};
    std::vector<std::string> topics{"/tf", recording_.names.odometry, recording_.names.objects};
    const std::string fixes = fixesTopic(bag);
    if (!fixes.empty()) topics.push_back(recording_.names.fixes = fixes);
    for (const rosbag::MessageInstance& instance : rosbag::View(bag, rosbag::TopicQuery(topics))) {
      now_s_ = instance.getTime().toSec();
      if (instance.getTopic() == recording_.names.odometry) {
        add(*instantiate<nav_msgs::Odometry>(instance));
      } else if (instance.getTopic() == recording_.names.objects) {
        objects_gate_.hold(*instantiate<SemanticObjectArray>(instance), odometry_gate_, now_s_, recording_.refused);
        if (!odometry_gate_.isHolding()) takeObjects();
      } else if (instance.getTopic() == fixes) {
        add(*instantiate<sensor_msgs::NavSatFix>(instance));
      } else {
        addTransforms(instance, false);
      }
    }
    std::stable_sort(recording_.fixes.begin(), recording_.fixes.end(),
                     [](const GnssFix& a, const GnssFix& b) { return a.stamp < b.stamp; });
    now_s_ = std::numeric_limits<double>::infinity();  // nothing more comes: what waits is decided now
    odometry_gate_.giveUpHeld(recording_.refused);
    takeObjects();
  }

  /// Empty if nobody asked for fixes and there are none.
  std::string fixesTopic(const rosbag::Bag& bag) const {
    if (!layout_.fixes_topic.empty()) return findTopic<sensor_msgs::NavSatFix>(bag, layout_.fixes_topic);
    const std::string expected = ros::message_traits::datatype<sensor_msgs::NavSatFix>();
    for (const rosbag::ConnectionInfo* connection : rosbag::View(bag).getConnections()) {
      if (withoutSlash(connection->topic) == kFixes && connection->datatype == expected) return connection->topic;
    }
    return {};
  }

  void require(bool condition, const std::string& problem) const {
    if (!condition) throw InputError(path_ + ": " + problem);
  }

  /// The topic of that name, with or without slash.
  template <class Message>
  std::string findTopic(const rosbag::Bag& bag, const std::string& name) const {
    std::string others;
    for (const rosbag::ConnectionInfo* connection : rosbag::View(bag).getConnections()) {
      if (withoutSlash(connection->topic) == withoutSlash(name)) {
        requireType<Message>(connection->topic, connection->datatype);
        return connection->topic;
      }
      others += (others.empty() ? "" : ", ") + connection->topic + " (" + connection->datatype + ")";
    }
    throw InputError(path_ + ": no messages on " + name + "; the bag has " + (others.empty() ? "no topic" : others));
  }

  template <class Message>
  void requireType(const std::string& topic, const std::string& type) const {
    const std::string expected = ros::message_traits::datatype<Message>();
    require(type == expected, "topic " + topic + " holds " + type + ", not " + expected);
  }

  template <class Message>
  boost::shared_ptr<Message> instantiate(const rosbag::MessageInstance& instance) const {
    const auto message = instance.instantiate<Message>();
    requireType<Message>(instance.getTopic(), instance.getDataType());
    require(message != nullptr, "topic " + instance.getTopic() + " holds " + instance.getDataType() +
                                    " of another version of this message");
    return message;
  }

  /// Messages of another type on the topic are somebody else's.
  template <class Message, class Use>
  void forEachOf(const rosbag::Bag& bag, const std::string& topic, const Use& use) const {
    for (const rosbag::MessageInstance& instance : rosbag::View(bag, rosbag::TopicQuery(topic))) {
      if (const auto message = instance.instantiate<Message>()) use(*message);
    }
  }

  void addTransforms(const rosbag::MessageInstance& instance, bool is_static) {
    const auto message = instance.instantiate<tf2_msgs::TFMessage>();
    if (message == nullptr) return;
    for (const auto& transform : message->transforms) transforms_.setTransform(transform, "bag", is_static);
  }

  void add(const nav_msgs::Odometry& message) {
    if (!odometry_gate_.isUsable(message, recording_.refused)) return;
    const std::vector<nav_msgs::Odometry> usable = odometry_gate_.pass(message, latest_, recording_.refused);
    if (usable.empty()) return;
    if (usable.size() > 1 && toStamp(usable.front().header.stamp) < *latest_) beginAgain();
    for (const nav_msgs::Odometry& sample : usable) {
      const StampedPose T_odom_base{toStamp(sample.header.stamp), fromMessage(sample.pose.pose)};
      recording_.odometry.push_back(
          {sinceOrigin(T_odom_base.stamp, recording_.names.odometry), T_odom_base.T_world_base});
      sensors_.addOdometry(T_odom_base);
      if (T_odom_base.T_world_base.isValid()) latest_ = std::max(latest_.value_or(0), T_odom_base.stamp);
    }
    takeObjects();
  }

  void add(const sensor_msgs::NavSatFix& message) {
    const std::optional<GnssFix> fix = toFix(message, sensors_, frames_, recording_.refused);
    if (!fix) return;
    recording_.fixes.push_back(*fix);
    recording_.fixes.back().stamp -= time_origin_;
  }

  /// The clock falls back: the node begins a new map.
  void beginAgain() {
    recording_.refused.odometry_before_jump += recording_.odometry.size();
    recording_.refused.objects_before_jump += recording_.detector_frames.size();
    recording_.odometry.clear();
    recording_.detector_frames.clear();
    recording_.fixes.clear();
    sensors_.forgetOdometry();
    latest_.reset();
  }

  /// A stamp as the recording has it, which is no ROS time if it is negative.
  Stamp sinceOrigin(Stamp stamp, const std::string& topic) const {
    require(stamp >= time_origin_, "topic " + layout_.time_origin_topic + " says " +
                                       formatFixed(secondsFromStamp(time_origin_), 3) + " s, which is later than " +
                                       topic + ", stamped " + formatFixed(secondsFromStamp(stamp), 3) + " s");
    return stamp - time_origin_;
  }

  void takeObjects() {
    while (auto frame = objects_gate_.next(odometry_gate_, latest_, now_s_, recording_.refused)) {
      frame->stamp -= time_origin_;  // before it: dropped and counted, as every stamp that is none
      frame->odometry_before = recording_.odometry.size();
      recording_.detector_frames.push_back(std::move(*frame));
    }
  }

  const std::string& path_;
  const NodeConfig& frames_;
  const BagLayout& layout_;
  Recording recording_;
  Stamp time_origin_ = 0;
  double now_s_ = 0.0;
  std::optional<Stamp> latest_;  ///< odometry in use
  tf2::BufferCore transforms_;
  OdometryGate odometry_gate_;
  SensorTransforms sensors_;
  ObjectsGate objects_gate_;
};

}  // namespace

Recording readBag(const std::string& path, const ClassTable& classes, const NodeConfig& frames,
                  const BagLayout& layout) {
  static_cast<void>(sizeOfFile(path));  // refuses what is no file, with the system's reason
  return BagReader(path, classes, frames, layout).read();
}

}  // namespace semantic_mht_slam
