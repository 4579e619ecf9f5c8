#include "semantic_mht_slam/ros/slam_node.h"

#include <chrono>
#include <utility>

#include "semantic_mht_slam/ros/conversions.h"
#include "semantic_mht_slam/ros/parameters.h"

namespace semantic_mht_slam {
namespace {

constexpr double kTrajectoryPause = 20.0;  // as long as it took, so that a long one takes no more than 5 % of the time
constexpr std::uint32_t kSubscriberQueue = 1000;  // a burst until the callback moves it to the bounded queue

double wallSeconds() {
  return ros::WallTime::now().toSec();
}

}  // namespace

SlamNode::SlamNode(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle, const SystemConfig& config,
                   const ClassTable& classes)
    : handle_(handle),
      config_(config),
      classes_(classes),
      live_(ros::NodeHandle(private_handle, "node/live")),
      sensors_(config.node.base_frame),
      slam_(std::make_unique<Slam>(config.slam, classes)),
      publisher_(handle, config.node, classes),
      jump_(stampFromSeconds(config.node.reset_after_jump_back_s)),
      queue_(static_cast<std::size_t>(config.node.queue_size)) {
  estimator_.method = nameOf(config.slam.method);
  noteStatus();
  subscribe();
  advertiseServices();
  ros::NodeHandle slow_handle(handle_);
  slow_handle.setCallbackQueue(&slow_queue_);
  slow_timer_ = slow_handle.createWallTimer(ros::WallDuration(config_.node.trajectory_period_s),
                                            &SlamNode::publishSlowTopics, this);
  diagnostics_ = std::make_unique<NodeDiagnostics>(handle_, private_handle, [this] { return status(); });
  worker_ = std::thread([this] { work(); });
  slow_spinner_.start();
}

SlamNode::~SlamNode() {
  odometry_subscriber_.shutdown();
  objects_subscriber_.shutdown();
  initial_pose_subscriber_.shutdown();
  services_.clear();
  diagnostics_.reset();
  slow_timer_.stop();
  slow_spinner_.stop();
  queue_.close();
  worker_.join();
}

void SlamNode::subscribe() {
  const auto at_once = ros::TransportHints().tcpNoDelay();  // or TCP may keep a message for 40 ms
  odometry_subscriber_ = handle_.subscribe<nav_msgs::Odometry>(
      "odometry", kSubscriberQueue, [this](const nav_msgs::OdometryConstPtr& message) { receive(message); },
      ros::VoidConstPtr(), at_once);
  initial_pose_subscriber_ = handle_.subscribe<geometry_msgs::PoseWithCovarianceStamped>(
      "initialpose", 1,
      [this](const geometry_msgs::PoseWithCovarianceStampedConstPtr& message) { expectAt(*message); });
  objects_subscriber_ = handle_.subscribe<SemanticObjectArray>(
      "objects", kSubscriberQueue, [this](const SemanticObjectArrayConstPtr& message) { receive(message); },
      ros::VoidConstPtr(), at_once);
}

void SlamNode::receive(const nav_msgs::OdometryConstPtr& message) {
  {
    const std::lock_guard<std::mutex> lock(status_mutex_);
    const ros::Time now = ros::Time::now();
    odometry_monitor_.arrived(toStamp(message->header.stamp), now.isZero() ? std::nullopt : std::optional(toStamp(now)),
                              wallSeconds());
  }
  queue_.push(message);
}

void SlamNode::receive(const SemanticObjectArrayConstPtr& message) {
  {
    const std::lock_guard<std::mutex> lock(status_mutex_);
    objects_monitor_.arrived(toStamp(message->header.stamp), odometry_monitor_.status(0.0).stamp, wallSeconds());
  }
  queue_.push(message);
}

void SlamNode::work() {
  using Clock = std::chrono::steady_clock;
  while (const std::optional<InputMessage> message = queue_.pop()) {
    const std::lock_guard<TicketMutex> lock(slam_mutex_);
    const std::size_t frames = slam_->counters().frames;
    const Clock::time_point begin = Clock::now();
    std::visit([this](const auto& pointer) { handle(*pointer); }, *message);
    const double time_ms = std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
    noteStatus();
    if (slam_->counters().frames > frames) {
      const std::lock_guard<std::mutex> status_lock(status_mutex_);
      frame_timer_.add(time_ms);
    }
    for (const std::string& line : droppedInput(estimator_, queue_.dropped(), odometry_subscriber_.getTopic(),
                                                objects_subscriber_.getTopic(), config_.node.base_frame)) {
      warnings_.warn(line);
    }
  }
}

void SlamNode::handle(const nav_msgs::Odometry& message) {
  if (!isExpectedFrame(message)) return;
  const Stamp stamp = toStamp(message.header.stamp);
  if (std::exchange(is_loaded_, false)) beginSessionUnlessGoingOn(message);
  if (jump_.isUnconfirmed(stamp, latestStamp())) return jump_.hold(message);
  if (const auto jumped = jump_.takeConfirmed(stamp, latestStamp())) {
    if (toStamp(jumped->header.stamp) < *latestStamp()) {
      const bool keeps_map = slam_->isLocalizing();
      ROS_WARN("time jumped back from %.3f s to %.3f s: %s", secondsFromStamp(*latestStamp()), secondsFromStamp(stamp),
               keeps_map ? "looking for the place in the map" : "starting a new map");
      keeps_map ? slam_->beginSession() : startAgain();
    }
    process(*jumped);
  }
  process(message);
  retryObjects();
}

void SlamNode::beginSessionUnlessGoingOn(const nav_msgs::Odometry& message) {
  const StampedPose next{toStamp(message.header.stamp), fromMessage(message.pose.pose)};
  const std::optional<StampedPose> last = slam_->latestOdometry();
  if (last && goesOn(*last, next)) return;
  ROS_INFO("the odometry does not go on where the loaded map ends: looking for the place in the map");
  slam_->beginSession();
}

void SlamNode::process(const nav_msgs::Odometry& message) {
  if (!slam_->addOdometry({toStamp(message.header.stamp), fromMessage(message.pose.pose)})) return;
  const LiveConfig live = live_.get();
  if (slam_->isLocated()) publisher_.publishPose(*slam_, live);
  publisher_.publishFrame(*slam_, live);
}

std::optional<Stamp> SlamNode::latestStamp() const {
  const std::optional<StampedPose> latest = slam_->latestPose();
  return latest ? std::optional(latest->stamp) : std::nullopt;
}

bool SlamNode::isExpectedFrame(const nav_msgs::Odometry& message) {
  const NodeConfig& node = config_.node;
  if (withoutSlash(message.header.frame_id) == node.odom_frame &&
      withoutSlash(message.child_frame_id) == node.base_frame) {
    return true;
  }
  ++estimator_.odometry_wrong_frames;
  estimator_.wrong_frames = "'" + message.header.frame_id + "' to '" + message.child_frame_id + "'";
  warnings_.warn(odometry_subscriber_.getTopic() + ": odometry from " + estimator_.wrong_frames +
                 " is ignored, expected is '" + node.odom_frame + "' to '" + node.base_frame +
                 "': set node/odom_frame and node/base_frame");
  return false;
}

void SlamNode::startAgain() {
  slam_ = std::make_unique<Slam>(config_.slam, classes_);
  publisher_.startAgain(*slam_);
  published_odometry_ = 0;
  is_localization_wanted_ = false;
  ++estimator_.resets;
}

void SlamNode::handle(const SemanticObjectArray& message) {
  const Stamp stamp = toStamp(message.header.stamp);
  const bool falls_back = jump_.isBack(stamp, last_objects_);
  last_objects_ = stamp;
  waiting_objects_.push_back(
      {message, falls_back, ros::WallTime::now() + ros::WallDuration(config_.node.tf_timeout_s)});
  if (!jump_.isHolding() && !is_loaded_) retryObjects();  // a session that may begin comes first
}

void SlamNode::retryObjects() {
  // Objects wait, in their order, for the transform of their sensor, and where they overtook a jump back in time, for
  // the odometry that tells of it. Nothing waits for them. A detector that is merely late does not wait: its stamps
  // rise.
  while (!waiting_objects_.empty()) {
    const auto& [message, falls_back, deadline] = waiting_objects_.front();
    const std::optional<Pose> T_base_sensor = sensors_.find(message.header.frame_id);
    const bool may_wait = ros::WallTime::now() < deadline;
    const bool overtook_jump = falls_back && jump_.isBack(toStamp(message.header.stamp), latestStamp());
    if (may_wait && (!T_base_sensor || overtook_jump)) return;
    if (T_base_sensor) {
      add(message, *T_base_sensor);
    } else {
      ++estimator_.objects_without_transform;
      estimator_.unconnected_frame = message.header.frame_id;
    }
    waiting_objects_.pop_front();
  }
}

void SlamNode::add(const SemanticObjectArray& message, const Pose& T_base_sensor) {
  for (const SemanticObject& object : message.objects) {
    if (!classes_.findId(object.class_id)) ++estimator_.unknown_classes[object.class_id];
  }
  std::size_t unknown_classes = 0;
  slam_->addDetections(toStamp(message.header.stamp), fromMessage(message, classes_, T_base_sensor, unknown_classes));
  publisher_.publishFrame(*slam_, live_.get());
}

void SlamNode::noteStatus() {
  estimator_.counters = slam_->counters();
  estimator_.mode = is_localization_wanted_ ? "localization" : "mapping";
  if (!slam_->isLocated()) estimator_.mode += ", lost";
  if (slam_->isFollowing()) estimator_.mode += ", known place";
  estimator_.hypotheses = slam_->hypotheses().size();
  estimator_.submaps = slam_->map().submaps().size();
  estimator_.landmarks = publisher_.landmarks();
  estimator_.loops = publisher_.loops();
  const std::lock_guard<std::mutex> lock(status_mutex_);
  noted_estimator_ = estimator_;
}

void SlamNode::publishSlowTopics(const ros::WallTimerEvent&) {
  std::unique_lock<TicketMutex> lock(slam_mutex_);
  if (live_.version() != published_live_) {
    published_live_ = live_.version();
    publisher_.publishMapMarkers(*slam_, live_.get());
  }
  const ros::WallTime begin = ros::WallTime::now();
  if (slam_->counters().odometry == published_odometry_ || begin < next_trajectory_) return;
  published_odometry_ = slam_->counters().odometry;
  const SlamPublisher::TrajectoryTurn turn = publisher_.takeTrajectoryTurn();
  const TrajectoryRecord record = slam_->trajectoryRecord();
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
  return std::make_unique<SlamNode>(handle, private_handle, config, loadClassTable(config, config_folder));
}

}  // namespace semantic_mht_slam
