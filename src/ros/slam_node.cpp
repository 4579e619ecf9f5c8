#include "semantic_mht_slam/ros/slam_node.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "semantic_mht_slam/bags/conversions.h"
#include "semantic_mht_slam/bags/fix_gate.h"
#include "semantic_mht_slam/common/length.h"
#include "semantic_mht_slam/ros/parameters.h"
#include "semantic_mht_slam/ros/starting_map.h"

namespace semantic_mht_slam {
namespace {

constexpr double kTrajectoryPause = 20.0;  // as long as it took, so that a long one takes no more than 5 % of the time

InputQueue::Clock::duration inWallTime(double seconds) {
  return std::chrono::duration_cast<InputQueue::Clock::duration>(std::chrono::duration<double>(seconds));
}

}  // namespace

SlamNode::SlamNode(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle, const SystemConfig& config,
                   const ClassTable& classes, std::unique_ptr<Slam> slam)
    : handle_(handle),
      config_(config),
      classes_(classes),
      live_(ros::NodeHandle(private_handle, "node/live")),
      slam_(std::move(slam)),
      publisher_(handle, config.node, classes),
      gate_(config.node),
      sensors_(transforms_, config.node),
      objects_gate_(config.node, classes_, sensors_, static_cast<std::size_t>(config.slam.input.max_waiting_frames)),
      is_localization_wanted_(config.node.mode == StartMode::kLocalization),
      is_loaded_(!config.node.map.empty()),
      queue_(static_cast<std::size_t>(config.node.queue_size), inWallTime(config.node.max_delay_s)) {
  estimator_.method = nameOf(config.slam.method);
  if (is_loaded_) publisher_.showLoaded(*slam_, live_.get());
  noteStatus();
  subscribe();
  advertiseServices();
  ros::NodeHandle slow_handle(handle_);
  slow_handle.setCallbackQueue(&slow_queue_);
  slow_timer_ = slow_handle.createWallTimer(
      ros::WallDuration(config_.node.trajectory_period_s), [this](const ros::WallTimerEvent&) {
        other_failures_.run("publishing the trajectory", [this] { publishSlowTopics(); });
      });
  diagnostics_ = std::make_unique<NodeDiagnostics>(handle_, private_handle, [this] { return status(); });
  worker_ = std::thread([this] { work(); });
  slow_spinner_.start();
  service_spinner_.start();
}

SlamNode::~SlamNode() {
  is_closing_ = true;  // no service waits any more
  queue_.close();
  odometry_subscriber_.shutdown();
  objects_subscriber_.shutdown();
  fixes_subscriber_.shutdown();
  initial_pose_subscriber_.shutdown();
  services_.clear();
  service_spinner_.stop();
  pose_timer_.stop();
  diagnostics_.reset();
  slow_timer_.stop();
  slow_spinner_.stop();
  worker_.join();
}

void SlamNode::work() {
  while (const std::optional<InputMessage> message = queue_.pop()) {
    const std::lock_guard<TicketMutex> lock(slam_mutex_);
    slam_->explain(publisher_.wantedExplanations());
    handleSafely(*message);
    noteHandled(*message);
    other_failures_.run("looking at the estimator", [this] {
      publisher_.publishAmbiguous(*slam_);
      noteStatus();
      warnOfDrops();
    });
  }
}

void SlamNode::handleSafely(const InputMessage& message) {
  if (const auto* fix = std::get_if<sensor_msgs::NavSatFixConstPtr>(&message)) {
    // It only waits in the estimator: that it does says nothing of whether the estimator fails.
    if (!input_failures_.status().isLasting()) other_failures_.run("fix", [&] { handle(**fix); });
    return;
  }
  const auto* odometry = std::get_if<nav_msgs::OdometryConstPtr>(&message);
  if (input_failures_.status().isLasting()) {
    if (odometry == nullptr) ++estimator_.objects_while_failing;
  } else if (input_failures_.run(odometry != nullptr ? "odometry" : "objects", [&] { handleTimed(message); })) {
    return;
  }
  if (odometry == nullptr || !isLocated(slam_->mode())) return;
  other_failures_.run("dead reckoning", [&] { deadReckon(**odometry); });
}

void SlamNode::handleTimed(const InputMessage& message) {
  using Clock = std::chrono::steady_clock;
  const std::size_t frames = slam_->parts().assembler.counters().frames;
  const Clock::time_point begin = Clock::now();
  std::visit([this](const auto& pointer) { handle(*pointer); }, message);
  const double time_ms = std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
  if (slam_->parts().assembler.counters().frames == frames) return;
  const std::lock_guard<std::mutex> status_lock(status_mutex_);
  frame_timer_.add(time_ms);
}

void SlamNode::deadReckon(const nav_msgs::Odometry& message) {
  const Pose T_odom_base = fromMessage(message.pose.pose);
  if (!gate_.isUsable(message, estimator_.refused) || !T_odom_base.isValid()) return;
  publisher_.publishDeadReckoning({toStamp(message.header.stamp), T_odom_base}, live_.get());
}

void SlamNode::warnOfDrops() {
  const std::size_t odometry = queue_.droppedOdometry();
  const std::size_t objects = queue_.droppedObjects();
  if (odometry > 0) {
    warnings_.warn(std::to_string(odometry) + " odometry messages dropped, the queue is full (node/queue_size)");
  }
  if (objects > 0) {
    warnings_.warn(std::to_string(objects) +
                   " messages of objects dropped, the estimator is too slow (node/max_delay)");
  }
  if (const std::size_t fixes = queue_.droppedFixes()) {
    warnings_.warn(std::to_string(fixes) + " fixes dropped, the queue is full (node/queue_size)");
  }
  const InputNames names{odometry_subscriber_.getTopic(), objects_subscriber_.getTopic(), config_.node.base_frame,
                         fixes_subscriber_.getTopic()};
  for (const std::string& line : droppedFixes(estimator_.fixes, estimator_.refused, names)) warnings_.warn(line);
  for (const std::string& line : droppedInput(estimator_.counters, estimator_.refused, names)) warnings_.warn(line);
  for (const FailureStatus& failures : {input_failures_.status(), other_failures_.status()}) {
    if (failures.count > 0)
      warnings_.warn("unexpected failures: " + std::to_string(failures.count) + "; the newest: " + failures.newest);
  }
}

void SlamNode::handle(const nav_msgs::Odometry& message) {
  if (!gate_.isUsable(message, estimator_.refused)) return;
  if (std::exchange(is_loaded_, false)) beginSessionUnlessGoingOn(message);
  const std::optional<Stamp> latest = latestStamp();
  const std::vector<nav_msgs::Odometry> usable = gate_.pass(message, latest, estimator_.refused);
  if (usable.empty()) return;  // until the next message tells whether time jumped
  if (usable.size() > 1 && toStamp(usable.front().header.stamp) < *latest) {
    const bool keeps_map = isLocalizing(slam_->mode());
    ROS_WARN("time jumped back from %.3f s to %.3f s: %s", secondsFromStamp(*latest), message.header.stamp.toSec(),
             keeps_map ? "looking for the place in the map" : "starting a new map");
    sensors_.forgetOdometry();
    plausibility_.clear();
    T_odom_last_.reset();
    publisher_.forgetPose();
    keeps_map ? slam_->beginSession() : startAgain();
  }
  for (const nav_msgs::Odometry& sample : usable) process(sample);
  retryObjects();
}

void SlamNode::beginSessionUnlessGoingOn(const nav_msgs::Odometry& message) {
  const StampedPose next{toStamp(message.header.stamp), fromMessage(message.pose.pose)};
  if (goesOn(*slam_, next)) return;
  ROS_INFO("the odometry does not go on where the loaded map ends: looking for the place in the map");
  slam_->beginSession();
}

void SlamNode::process(const nav_msgs::Odometry& message) {
  const StampedPose T_odom_base{toStamp(message.header.stamp), fromMessage(message.pose.pose)};
  const std::size_t sessions = slam_->parts().sessions.count();
  const bool is_used = slam_->addOdometry(T_odom_base);
  estimator_.odometry_jumps += slam_->parts().sessions.count() - sessions;
  if (!is_used) return;
  sensors_.addOdometry(T_odom_base);
  noteWay(T_odom_base);
  const LiveConfig live = live_.get();
  if (isLocated(slam_->mode())) {
    publisher_.publishPose(*slam_, live);
  } else {
    publisher_.forgetPose();
  }
  publisher_.publishFrame(*slam_, live);
}

void SlamNode::publishMap() {
  publisher_.publishMap(*slam_, live_.get());
  publisher_.publishAmbiguous(*slam_);
}

void SlamNode::noteWay(const StampedPose& T_odom_base) {
  plausibility_.add(T_odom_base);
  if (T_odom_last_ && !isLocated(slam_->mode())) {
    estimator_.lost_m += (T_odom_last_->inverse() * T_odom_base.T_world_base).translation_m.norm();
  }
  if (isLocated(slam_->mode())) estimator_.lost_m = 0.0;
  T_odom_last_ = T_odom_base.T_world_base;
}

std::optional<Stamp> SlamNode::latestStamp() const {
  const std::optional<StampedPose> latest = latestPoseOf(*slam_);
  return latest ? std::optional(latest->stamp) : std::nullopt;
}

void SlamNode::startAgain() {
  slam_ = std::make_unique<Slam>(config_.slam, classes_);
  publisher_.startAgain(*slam_);
  plausibility_.clear();
  published_odometry_ = 0;
  is_localization_wanted_ = false;
  input_failures_.forgetRow();
  ++estimator_.resets;
}

void SlamNode::handle(const SemanticObjectArray& message) {
  if (is_paused_) {
    ++estimator_.objects_while_paused;
    return;
  }
  objects_gate_.hold(message, gate_, ros::WallTime::now().toSec(), estimator_.refused);
  if (!gate_.isHolding() && !is_loaded_) retryObjects();  // a session that may begin comes first
}

void SlamNode::handle(const sensor_msgs::NavSatFix& message) {
  const bool may_begin_session = is_loaded_ || gate_.isHolding();  // the next odometry tells
  const auto fix = may_begin_session ? std::nullopt : toFix(message, sensors_, config_.node, estimator_.refused);
  if (may_begin_session || (fix && !slam_->addFix(*fix))) ++estimator_.refused.fixes_without_mapping;
}

void SlamNode::retryObjects() {
  while (auto frame = objects_gate_.next(gate_, latestStamp(), ros::WallTime::now().toSec(), estimator_.refused)) {
    plausibility_.add(*frame);
    slam_->addDetections(frame->stamp, std::move(frame->detections));
    publisher_.publishFrame(*slam_, live_.get());
  }
}

void SlamNode::noteStatus() {
  estimator_.counters = slam_->parts().assembler.counters();
  estimator_.fixes = slam_->parts().fixes.counters();
  estimator_.is_map_placed = geoReferenceOf(*slam_).has_value();
  estimator_.mode = is_localization_wanted_ ? "localization" : "mapping";
  estimator_.is_lost = !isLocated(slam_->mode());
  if (estimator_.is_lost) estimator_.mode += ", lost";
  if (isFollowing(slam_->mode())) estimator_.mode += ", known place";
  if (is_paused_) estimator_.mode += ", paused";
  estimator_.hypotheses = hypothesesOf(*slam_).size();
  estimator_.submaps = slam_->map().submaps().size();
  estimator_.landmarks = publisher_.landmarks();
  estimator_.loops = publisher_.loops();
  estimator_.graph = slam_->parts().graph.status();
  estimator_.oddities = plausibility_.look();
  estimator_.objects_fixed_frame = objects_gate_.fixedFrame();
  estimator_.driven_m = slam_->parts().driven.way_m;
  estimator_.far_m = slam_->parts().range_factor * Length::kReferenceRange_m;
  const std::lock_guard<std::mutex> lock(status_mutex_);
  noted_estimator_ = estimator_;
}

void SlamNode::publishSlowTopics() {
  std::unique_lock<TicketMutex> lock(slam_mutex_);
  if (live_.version() != published_live_) {
    published_live_ = live_.version();
    publisher_.publishMapMarkers(*slam_, live_.get());
  }
  const ros::WallTime begin = ros::WallTime::now();
  if (slam_->parts().assembler.counters().odometry == published_odometry_ || begin < next_trajectory_) return;
  published_odometry_ = slam_->parts().assembler.counters().odometry;
  const SlamPublisher::TrajectoryTurn turn = publisher_.takeTrajectoryTurn();
  const TrajectoryRecord record = trajectoryRecordOf(*slam_);
  const std::vector<Pose> odometry = publisher_.odometry();
  lock.unlock();  // the trajectory of a long drive and its messages take a while to make
  publisher_.publishTrajectory(turn, trajectoryOf(record), odometry);
  const ros::WallTime end = ros::WallTime::now();
  next_trajectory_ = end + ros::WallDuration(kTrajectoryPause * (end - begin).toSec());
}

std::unique_ptr<SlamNode> makeSlamNode(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle,
                                       const std::string& config_folder) {
  SystemConfig config = makeSystemConfig(readParameters(private_handle));
  requireUsableFrames(config.node);
  config.slam = loadableSlamConfig(config, config_folder);
  const ClassTable classes = loadClassTable(config, config_folder);
  return std::make_unique<SlamNode>(handle, private_handle, config, classes, startingSlam(config, classes));
}

}  // namespace semantic_mht_slam
