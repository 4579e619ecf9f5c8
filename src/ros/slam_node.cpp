#include "semantic_mht_slam/ros/slam_node.h"

#include <algorithm>
#include <cctype>
#include <iterator>

#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <nav_msgs/Path.h>
#include <visualization_msgs/MarkerArray.h>

#include "semantic_mht_slam/ros/conversions.h"
#include "semantic_mht_slam/ros/markers.h"

namespace semantic_mht_slam {
namespace {

constexpr double kWarningPeriod_s = 5.0;
constexpr std::uint32_t kSubscriberQueue = 1000;  // a burst until the callback moves it to the bounded queue

}  // namespace

SlamNode::SlamNode(const ros::NodeHandle& handle, const SystemConfig& config, const ClassTable& classes)
    : handle_(handle),
      config_(config),
      classes_(classes),
      transform_listener_(transforms_),
      pose_publisher_(handle_.advertise<geometry_msgs::PoseWithCovarianceStamped>("pose", 100)),
      trajectory_publisher_(handle_.advertise<nav_msgs::Path>("trajectory", 1, true)),
      objects_publisher_(handle_.advertise<visualization_msgs::MarkerArray>("markers/objects", 10, true)),
      hypotheses_publisher_(handle_.advertise<HypothesisTree>("hypotheses", 10)),
      map_publisher_(handle_.advertise<SemanticMap>("map", 1, true)),
      slam_(std::make_unique<Slam>(config.slam, classes)),
      jump_(stampFromSeconds(config.node.reset_after_jump_back_s)),
      queue_(static_cast<std::size_t>(config.node.queue_size)) {
  odometry_subscriber_ = handle_.subscribe<nav_msgs::Odometry>(
      "odometry", kSubscriberQueue, [this](const nav_msgs::OdometryConstPtr& message) { queue_.push(message); });
  objects_subscriber_ = handle_.subscribe<SemanticObjectArray>(
      "objects", kSubscriberQueue, [this](const SemanticObjectArrayConstPtr& message) { queue_.push(message); });
  trajectory_timer_ =
      handle_.createWallTimer(ros::WallDuration(config_.node.trajectory_period_s), &SlamNode::publishTrajectory, this);
  worker_ = std::thread([this] { work(); });
}

SlamNode::~SlamNode() {
  odometry_subscriber_.shutdown();
  objects_subscriber_.shutdown();
  queue_.close();
  worker_.join();
}

void SlamNode::work() {
  while (const std::optional<InputMessage> message = queue_.pop()) {
    std::visit([this](const auto& pointer) { handle(*pointer); }, *message);
    reportProblems();
  }
}

void SlamNode::handle(const nav_msgs::Odometry& message) {
  if (!isExpectedFrame(message)) return;
  const Stamp stamp = toStamp(message.header.stamp);
  const std::lock_guard<std::mutex> lock(slam_mutex_);
  if (jump_.isUnconfirmed(stamp, latestStamp())) return jump_.hold(message);
  if (const auto jumped = jump_.takeConfirmed(stamp, latestStamp())) {
    if (toStamp(jumped->header.stamp) < *latestStamp()) startAgain(stamp);
    process(*jumped);
  }
  process(message);
  retryObjects();
}

void SlamNode::process(const nav_msgs::Odometry& message) {
  if (!slam_->addOdometry({toStamp(message.header.stamp), fromMessage(message.pose.pose)})) return;
  publishPose();
  publishObjects();
}

std::optional<Stamp> SlamNode::latestStamp() const {
  const std::optional<StampedPose> latest = slam_->latestPose();
  return latest ? std::optional(latest->stamp) : std::nullopt;
}

bool SlamNode::isExpectedFrame(const nav_msgs::Odometry& message) {
  const NodeConfig& node = config_.node;
  if (message.header.frame_id == node.odom_frame && message.child_frame_id == node.base_frame) return true;
  warn(odometry_subscriber_.getTopic() + ": odometry from '" + message.header.frame_id + "' to '" +
       message.child_frame_id + "' is ignored, expected is '" + node.odom_frame + "' to '" + node.base_frame +
       "': set node/odom_frame and node/base_frame");
  return false;
}

void SlamNode::warn(const std::string& text) {
  // By wall time: a clock that stands still is one of the things to warn about. Counts in a text do not make it new.
  std::string kind;
  std::copy_if(text.begin(), text.end(), std::back_inserter(kind),
               [](unsigned char c) { return std::isdigit(c) == 0; });
  ros::WallTime& last = last_warning_[kind];
  const ros::WallTime now = ros::WallTime::now();
  if (now - last < ros::WallDuration(kWarningPeriod_s)) return;
  last = now;
  ROS_WARN_STREAM(text);
}

void SlamNode::startAgain(Stamp stamp) {
  ROS_WARN("time jumped back from %.3f s to %.3f s: starting a new map", secondsFromStamp(*latestStamp()),
           secondsFromStamp(stamp));
  slam_ = std::make_unique<Slam>(config_.slam, classes_);
  published_odometry_ = 0;
  published_frame_.reset();
  published_submaps_ = 0;
}

void SlamNode::handle(const SemanticObjectArray& message) {
  const std::lock_guard<std::mutex> lock(slam_mutex_);
  waiting_objects_.push_back({message, ros::WallTime::now() + ros::WallDuration(config_.node.tf_timeout_s)});
  if (!jump_.isHolding()) retryObjects();
}

void SlamNode::retryObjects() {
  // Objects wait for the transform of their sensor, in their order, and nothing waits for them.
  while (!waiting_objects_.empty()) {
    const auto& [message, deadline] = waiting_objects_.front();
    const std::optional<Pose> T_base_sensor = findSensor(message.header.frame_id);
    if (!T_base_sensor && ros::WallTime::now() < deadline) return;
    if (T_base_sensor) {
      slam_->addDetections(toStamp(message.header.stamp),
                           fromMessage(message, classes_, *T_base_sensor, unknown_classes_));
      publishObjects();
    } else {
      ++without_transform_;
      unconnected_frame_ = message.header.frame_id;
    }
    waiting_objects_.pop_front();
  }
}

void SlamNode::publishObjects() {
  const std::optional<Frame>& frame = slam_->latestFrame();
  if (!frame || frame->stamp == published_frame_) return;
  published_frame_ = frame->stamp;
  objects_publisher_.publish(toObjectMarkers(*frame, slam_->T_map_odom(), classes_, config_.node.map_frame));
  if (slam_->hypotheses().empty()) return;
  hypotheses_publisher_.publish(toMessage(*frame, config_.node.map_frame, slam_->submapIndex(), slam_->hypotheses()));
  const std::size_t submaps = slam_->map().submaps().size();
  if (submaps == published_submaps_) return;
  published_submaps_ = submaps;
  map_publisher_.publish(toMessage(frame->stamp, config_.node.map_frame, classes_, slam_->landmarks(), submaps));
}

std::optional<Pose> SlamNode::findSensor(const std::string& sensor_frame) {
  const auto known = T_base_sensor_.find(sensor_frame);
  if (known != T_base_sensor_.end()) return known->second;
  // Sensors are fixed to the base, so one look-up is enough.
  const std::string& base_frame = config_.node.base_frame;
  if (!transforms_.canTransform(base_frame, sensor_frame, ros::Time(0))) return std::nullopt;
  const auto transform = transforms_.lookupTransform(base_frame, sensor_frame, ros::Time(0));
  return T_base_sensor_.emplace(sensor_frame, fromMessage(transform.transform)).first->second;
}

void SlamNode::publishPose() {
  const StampedPose latest = *slam_->latestPose();
  const NodeConfig& node = config_.node;
  transform_broadcaster_.sendTransform(
      toTransform({latest.stamp, slam_->T_map_odom()}, node.map_frame, node.odom_frame));
  geometry_msgs::PoseWithCovarianceStamped message;
  message.header.stamp = toRosTime(latest.stamp);
  message.header.frame_id = node.map_frame;
  message.pose.pose = toMessage(latest.T_world_base);
  pose_publisher_.publish(message);
}

void SlamNode::publishTrajectory(const ros::WallTimerEvent&) {
  std::vector<StampedPose> trajectory;
  {
    const std::lock_guard<std::mutex> lock(slam_mutex_);
    if (slam_->counters().odometry == published_odometry_) return;
    published_odometry_ = slam_->counters().odometry;
    trajectory = slam_->trajectory();
  }
  trajectory_publisher_.publish(toPath(trajectory, config_.node.map_frame));
}

void SlamNode::reportProblems() {
  const InputCounters& counters = slam_->counters();
  const std::string odometry = odometry_subscriber_.getTopic() + ": ";
  const std::string objects = objects_subscriber_.getTopic() + ": ";
  const auto report = [this](std::size_t count, const std::string& topic, const std::string& problem) {
    if (count > 0) warn(topic + std::to_string(count) + " " + problem);
  };
  report(queue_.dropped(), "", "messages dropped so far, the estimator is too slow (node/queue_size)");
  report(counters.odometry_invalid, odometry, "messages dropped so far: not finite, or a quaternion without unit norm");
  report(counters.odometry_not_rising, odometry, "messages dropped so far: the stamp does not rise");
  report(
      without_transform_, objects,
      "messages dropped so far: no transform from '" + unconnected_frame_ + "' to '" + config_.node.base_frame + "'");
  report(unknown_classes_, objects, "objects dropped so far: their class id is not in the class table");
  report(counters.detections_invalid, objects,
         "objects dropped so far: position, covariance, score or size is unusable");
  report(counters.frames_before_odometry, objects, "messages dropped so far: older than the odometry");
  report(counters.frames_not_rising, objects, "messages dropped so far: the stamp does not rise");
  report(counters.frames_far_ahead, objects, "messages dropped so far: the stamp is far ahead of the odometry");
  report(counters.frames_in_odometry_gap, objects, "messages dropped so far: in a gap of the odometry");
  report(counters.frames_waiting_too_long, objects, "messages dropped so far: waited too long for odometry");
}

}  // namespace semantic_mht_slam
