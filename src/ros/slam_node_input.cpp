#include <algorithm>

#include "semantic_mht_slam/bags/conversions.h"
#include "semantic_mht_slam/ros/slam_node.h"

// What comes to the node, until the worker takes it, and what goes out if the worker does not come to it.
namespace semantic_mht_slam {
namespace {

constexpr std::uint32_t kSubscriberQueue = 1000;  // a burst until the callback moves it to the bounded queue
constexpr double kOverdue_s = 0.05;               // of the worker, after which the pose goes out without it
constexpr Stamp kFarAhead = 60LL * 1000000000LL;

}  // namespace

void SlamNode::subscribe() {
  pose_timer_ = handle_.createWallTimer(ros::WallDuration(0.5 * kOverdue_s),
                                        [this](const ros::WallTimerEvent&) { publishOverduePose(); });
  const auto at_once = ros::TransportHints().tcpNoDelay();  // or TCP may keep a message for 40 ms
  using OdometryEvent = const ros::MessageEvent<nav_msgs::Odometry const>&;
  using ObjectsEvent = const ros::MessageEvent<SemanticObjectArray const>&;
  const boost::function<void(OdometryEvent)> on_odometry = [this](OdometryEvent event) {
    receive(event.getConstMessage(), event.getPublisherName());
  };
  const boost::function<void(ObjectsEvent)> on_objects = [this](ObjectsEvent event) {
    receive(event.getConstMessage(), event.getPublisherName());
  };
  odometry_subscriber_ = handle_.subscribe<nav_msgs::Odometry, OdometryEvent>("odometry", kSubscriberQueue, on_odometry,
                                                                              ros::VoidConstPtr(), at_once);
  objects_subscriber_ = handle_.subscribe<SemanticObjectArray, ObjectsEvent>("objects", kSubscriberQueue, on_objects,
                                                                             ros::VoidConstPtr(), at_once);
  fixes_subscriber_ = handle_.subscribe<sensor_msgs::NavSatFix>(
      "fix", kSubscriberQueue, [this](const sensor_msgs::NavSatFixConstPtr& message) { receive(message); },
      ros::VoidConstPtr(), at_once);
  ros::NodeHandle service_handle(handle_);
  service_handle.setCallbackQueue(&service_queue_);
  initial_pose_subscriber_ = service_handle.subscribe<geometry_msgs::PoseWithCovarianceStamped>(
      "initialpose", 1, [this](const geometry_msgs::PoseWithCovarianceStampedConstPtr& message) {
        other_failures_.run("initialpose", [&] { expectAt(*message); });
      });
}

void SlamNode::receive(const nav_msgs::OdometryConstPtr& message, const std::string& publisher) {
  {
    const std::lock_guard<std::mutex> lock(status_mutex_);
    const ros::Time now = ros::Time::now();
    odometry_monitor_.arrived(toStamp(message->header.stamp), now.isZero() ? std::nullopt : std::optional(toStamp(now)),
                              ros::WallTime::now().toSec());
    odometry_gaps_.arrived(publisher, message->header.seq);
    unhandled_.push_back({message, ros::WallTime::now()});
    if (unhandled_.size() > static_cast<std::size_t>(config_.node.queue_size)) unhandled_.pop_front();
  }
  queue_.push(message);
  publishOverduePose();
}

/// A pose by odometry alone if the worker has been behind for too long.
void SlamNode::publishOverduePose() {
  nav_msgs::OdometryConstPtr message;
  {
    const std::lock_guard<std::mutex> lock(status_mutex_);
    const bool is_behind =
        !unhandled_.empty() && (ros::WallTime::now() - unhandled_.front().since).toSec() > kOverdue_s;
    if (!is_behind || !handled_odometry_) return;
    message = unhandled_.back().message;
    const Stamp ahead = toStamp(message->header.stamp) - *handled_odometry_;
    if (ahead <= 0 || ahead > kFarAhead) return;  // a jump: the worker finds out
  }
  RefusedInput counted_by_worker;
  const StampedPose T_odom_base{toStamp(message->header.stamp), fromMessage(message->pose.pose)};
  if (!gate_.isUsable(*message, counted_by_worker) || !T_odom_base.T_world_base.isValid()) return;
  other_failures_.run("pose by odometry", [&] { publisher_.publishDeadReckoning(T_odom_base, live_.get()); });
}

void SlamNode::receive(const SemanticObjectArrayConstPtr& message, const std::string& publisher) {
  {
    const std::lock_guard<std::mutex> lock(status_mutex_);
    objects_monitor_.arrived(toStamp(message->header.stamp), odometry_monitor_.status(0.0).stamp,
                             ros::WallTime::now().toSec());
    objects_gaps_.arrived(publisher, message->header.seq);
  }
  queue_.push(message);
}

void SlamNode::noteHandled(const InputMessage& message) {
  const auto* odometry = std::get_if<nav_msgs::OdometryConstPtr>(&message);
  if (odometry == nullptr) return;
  const std::lock_guard<std::mutex> lock(status_mutex_);
  handled_odometry_ = latestStamp();
  const auto is_it = [&](const UnhandledOdometry& waiting) { return waiting.message == *odometry; };
  const auto handled = std::find_if(unhandled_.begin(), unhandled_.end(), is_it);  // those before it were dropped
  if (handled != unhandled_.end()) unhandled_.erase(unhandled_.begin(), handled + 1);
}

}  // namespace semantic_mht_slam
