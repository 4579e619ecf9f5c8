#include "semantic_mht_slam/ros/slam_node.h"

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
      slam_(std::make_unique<Slam>(config.slam)),
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
  startAgainAfterJumpBack(stamp);
  if (!slam_->addOdometry({stamp, fromMessage(message.pose.pose)})) return;
  publishPose();
  publishObjects();
}

bool SlamNode::isExpectedFrame(const nav_msgs::Odometry& message) const {
  const NodeConfig& node = config_.node;
  if (message.header.frame_id == node.odom_frame && message.child_frame_id == node.base_frame) return true;
  ROS_WARN_THROTTLE(kWarningPeriod_s,
                    "%s: odometry from '%s' to '%s' is ignored, expected is '%s' to '%s': set node/odom_frame and "
                    "node/base_frame",
                    odometry_subscriber_.getTopic().c_str(), message.header.frame_id.c_str(),
                    message.child_frame_id.c_str(), node.odom_frame.c_str(), node.base_frame.c_str());
  return false;
}

void SlamNode::startAgainAfterJumpBack(Stamp stamp) {
  const std::optional<StampedPose> latest = slam_->latestPose();
  if (!latest || stamp >= latest->stamp - stampFromSeconds(config_.node.reset_after_jump_back_s)) return;
  ROS_WARN("time jumped back from %.3f s to %.3f s: starting a new map", secondsFromStamp(latest->stamp),
           secondsFromStamp(stamp));
  slam_ = std::make_unique<Slam>(config_.slam);
  published_odometry_ = 0;
  published_frame_.reset();
}

void SlamNode::handle(const SemanticObjectArray& message) {
  const std::optional<Pose> T_base_sensor = findSensor(message.header.frame_id);
  if (!T_base_sensor) return;
  Detections detections = fromMessage(message, classes_, *T_base_sensor, unknown_classes_);
  const std::lock_guard<std::mutex> lock(slam_mutex_);
  slam_->addDetections(toStamp(message.header.stamp), std::move(detections));
  publishObjects();
}

void SlamNode::publishObjects() {
  const std::optional<Frame>& frame = slam_->latestFrame();
  if (!frame || frame->stamp == published_frame_) return;
  published_frame_ = frame->stamp;
  objects_publisher_.publish(toObjectMarkers(*frame, slam_->T_map_odom(), classes_, config_.node.map_frame));
}

std::optional<Pose> SlamNode::findSensor(const std::string& sensor_frame) {
  const std::string& base_frame = config_.node.base_frame;
  const auto known = T_base_sensor_.find(sensor_frame);
  const bool is_first = known == T_base_sensor_.end();
  if (!is_first && known->second) return known->second;
  // Sensors are fixed to the base. Their transform may arrive after their first message; waiting once is enough.
  const ros::WallTime deadline = ros::WallTime::now() + ros::WallDuration(is_first ? config_.node.tf_timeout_s : 0.0);
  while (!transforms_.canTransform(base_frame, sensor_frame, ros::Time(0)) && ros::WallTime::now() < deadline) {
    ros::WallDuration(0.01).sleep();
  }
  std::optional<Pose>& T_base_sensor = T_base_sensor_[sensor_frame];
  try {
    T_base_sensor = fromMessage(transforms_.lookupTransform(base_frame, sensor_frame, ros::Time(0)).transform);
  } catch (const tf2::TransformException& error) {
    ROS_WARN_THROTTLE(kWarningPeriod_s, "%s: objects in frame '%s' are dropped, no transform to '%s': %s",
                      objects_subscriber_.getTopic().c_str(), sensor_frame.c_str(), base_frame.c_str(), error.what());
  }
  return T_base_sensor;
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
  if (const std::size_t dropped = queue_.dropped()) {
    ROS_WARN_THROTTLE(kWarningPeriod_s, "the estimator is too slow: %zu messages dropped so far (node/queue_size)",
                      dropped);
  }
  if (unknown_classes_ > 0) {
    ROS_WARN_THROTTLE(kWarningPeriod_s, "%s: %zu objects with a class id that the class table lacks so far",
                      objects_subscriber_.getTopic().c_str(), unknown_classes_);
  }
  const std::size_t bad_odometry = counters.odometry_invalid + counters.odometry_not_rising;
  if (bad_odometry > 0) {
    ROS_WARN_THROTTLE(kWarningPeriod_s, "%s: dropped so far: %zu not finite, %zu with a stamp that does not rise",
                      odometry_subscriber_.getTopic().c_str(), counters.odometry_invalid, counters.odometry_not_rising);
  }
  const std::size_t bad_frames = counters.frames_before_odometry + counters.frames_not_rising +
                                 counters.frames_in_odometry_gap + counters.frames_waiting_too_long;
  if (bad_frames + counters.detections_invalid > 0) {
    ROS_WARN_THROTTLE(
        kWarningPeriod_s,
        "%s: frames dropped so far: %zu older than the odometry, %zu with a stamp that does not rise, %zu "
        "in a gap of the odometry, %zu waited too long for odometry; %zu objects with unusable numbers",
        objects_subscriber_.getTopic().c_str(), counters.frames_before_odometry, counters.frames_not_rising,
        counters.frames_in_odometry_gap, counters.frames_waiting_too_long, counters.detections_invalid);
  }
}

}  // namespace semantic_mht_slam
