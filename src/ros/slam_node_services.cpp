#include <algorithm>
#include <chrono>
#include <cmath>
#include <future>
#include <memory>
#include <stdexcept>
#include <utility>

#include <boost/make_shared.hpp>
#include <ros/callback_queue.h>

#include "semantic_mht_slam/bags/conversions.h"
#include "semantic_mht_slam/bags/map_file.h"
#include "semantic_mht_slam/bags/readable_map.h"
#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/ros/landmark_choice.h"
#include "semantic_mht_slam/ros/map_path.h"
#include "semantic_mht_slam/ros/slam_node.h"

// What other nodes ask of the node: its services, and the status behind its diagnostics.
namespace semantic_mht_slam {
namespace {

constexpr double kFarthest_m = 1e7;  // a quarter round the Earth

/// Tells when its turn has come in a queue of callbacks.
class Marker final : public ros::CallbackInterface {
 public:
  explicit Marker(std::shared_ptr<std::promise<void>> has_come) : has_come_(std::move(has_come)) {}

  CallResult call() override {
    has_come_->set_value();
    return Success;
  }

 private:
  std::shared_ptr<std::promise<void>> has_come_;
};

}  // namespace

void SlamNode::advertiseServices() {
  ros::NodeHandle handle(handle_);
  handle.setCallbackQueue(&service_queue_);
  services_.push_back(handle.advertiseService("finish_submap", &SlamNode::finishSubmap, this));
  services_.push_back(handle.advertiseService("reset", &SlamNode::reset, this));
  services_.push_back(handle.advertiseService("pause", &SlamNode::pause, this));
  services_.push_back(handle.advertiseService("resume", &SlamNode::resume, this));
  services_.push_back(handle.advertiseService("get_landmarks", &SlamNode::getLandmarks, this));
  services_.push_back(handle.advertiseService("save_map", &SlamNode::saveMap, this));
  services_.push_back(handle.advertiseService("load_map", &SlamNode::loadMap, this));
  services_.push_back(handle.advertiseService("set_mode", &SlamNode::setMode, this));
  advertiseRequests(handle);
}

std::unique_lock<TicketMutex> SlamNode::lockCaughtUp() {
  waitForSubscribers();
  queue_.waitUntilHandled([] { return ros::ok(); });
  std::unique_lock<TicketMutex> lock(slam_mutex_);
  slam_->explain(publisher_.wantedExplanations());
  return lock;
}

/// Until the messages that the node had received before the call are in the queue. They are called in their order: what
/// is put behind them comes after them.
void SlamNode::waitForSubscribers() {
  const auto has_come = std::make_shared<std::promise<void>>();
  ros::CallbackQueueInterface* own = handle_.getCallbackQueue();
  ros::CallbackQueueInterface& queue = own != nullptr ? *own : *ros::getGlobalCallbackQueue();
  queue.addCallback(boost::make_shared<Marker>(has_come));
  std::future<void> coming = has_come->get_future();
  while (coming.wait_for(std::chrono::milliseconds(50)) != std::future_status::ready) {
    if (is_closing_ || !ros::ok()) return;
  }
}

bool SlamNode::finishSubmap(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  return answer("finish_submap", response, [&] {
    const auto lock = lockCaughtUp();
    const std::size_t before = slam_->map().submaps().size();
    slam_->finish();
    const std::size_t submaps = slam_->map().submaps().size();
    response.success = submaps > before;
    if (!response.success) {
      response.message = config_.slam.method == Method::kOdometry ? "the method 'odometry' makes no map"
                                                                  : "no submap is open: no objects since the last one";
      return;
    }
    publishMap();
    published_odometry_ = 0;  // the trajectory may have been corrected
    noteStatus();
    response.message = "submap " + std::to_string(submaps - 1) + " is finished; the map holds " +
                       std::to_string(publisher_.landmarks()) + " landmarks";
  });
}

bool SlamNode::reset(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  return answer("reset", response, [&] {
    const auto lock = lockCaughtUp();
    const std::size_t landmarks = publisher_.landmarks();
    objects_gate_.clear(estimator_.refused);
    startAgain();
    noteStatus();
    response.success = true;
    response.message = "a new map begins; the old one had " + std::to_string(landmarks) + " landmarks";
  });
}

bool SlamNode::pause(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  return answer("pause", response, [&] {
    const auto lock = lockCaughtUp();
    response.success = !std::exchange(is_paused_, true);
    response.message = response.success ? "objects are not used until resume; the pose goes on by odometry"
                                        : "the node is paused already";
    noteStatus();
  });
}

bool SlamNode::resume(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  return answer("resume", response, [&] {
    const auto lock = lockCaughtUp();
    response.success = std::exchange(is_paused_, false);
    response.message = response.success ? "objects are used again" : "the node is not paused";
    noteStatus();
  });
}

bool SlamNode::getLandmarks(GetLandmarks::Request& request, GetLandmarks::Response& response) {
  return answer("get_landmarks", response, [&] {
    const auto lock = lockCaughtUp();
    try {
      response.landmarks = chosenLandmarks(publisher_.map(), request);
    } catch (const InputError& error) {
      response.message = error.what();
      return;
    }
    response.header = publisher_.map().header;
    response.success = true;
    response.message = std::to_string(response.landmarks.size()) + " of " +
                       std::to_string(publisher_.map().landmarks.size()) + " landmarks";
  });
}

bool SlamNode::saveMap(SaveMap::Request& request, SaveMap::Response& response) {
  return answer("save_map", response, [&] {
    try {
      const std::string path = mapPath(request.path, config_.node.map_folder);
      auto lock = lockCaughtUp();
      const SavedMap map = mapOf(*slam_, [&] { lock.unlock(); });
      response.bytes = writeMapFile(path, map, config_, classes_);
      response.success = true;
      response.message = std::to_string(map.landmarks.size()) + " landmarks of " + std::to_string(map.submaps) +
                         " finished submaps, and the open one, are in '" + path + "'";
    } catch (const InputError& error) {
      response.message = error.what();
    }
  });
}

bool SlamNode::loadMap(LoadMap::Request& request, LoadMap::Response& response) {
  return answer("load_map", response, [&] {
    std::unique_ptr<Slam> other;  // the loaded one, and then the one before
    std::string remark;
    const KeepReading keep_reading = [this] { return ros::ok() && !is_closing_; };
    try {
      const std::string path = mapPath(request.path, config_.node.map_folder);
      LoadedMap map = readMapFile(path, config_, classes_, keep_reading);
      if (!map.has_same_parameters) remark = "; it was made with other parameters than the present ones";
      if (!map.remade.empty()) remark += "; " + describeRemade(map);
      other =
          std::make_unique<Slam>(config_.slam, classes_, stateOf(std::move(map), config_.slam, classes_), keep_reading);
    } catch (const InputError& error) {
      response.message = std::string(error.what()) + "; the running map stays";
      return;
    }
    const auto lock = lockCaughtUp();
    slam_.swap(other);
    try {
      if (is_localization_wanted_ && !slam_->map().submaps().empty()) slam_->localize();
      publisher_.showLoaded(*slam_, live_.get());
    } catch (const std::exception& error) {
      slam_.swap(other);
      publisher_.showLoaded(*slam_, live_.get());
      response.message = request.path + ": cannot be gone on with: " + error.what() + "; the running map stays";
      return;
    }
    is_loaded_ = true;
    objects_gate_.clear(estimator_.refused);
    published_odometry_ = 0;
    input_failures_.forgetRow();
    noteStatus();
    response.success = true;
    response.message = "the map has " + std::to_string(publisher_.landmarks()) + " landmarks of " +
                       std::to_string(slam_->map().submaps().size()) + " finished submaps" + remark;
  });
}

bool SlamNode::setMode(SetMode::Request& request, SetMode::Response& response) {
  return answer("set_mode", response, [&] {
    const auto lock = lockCaughtUp();
    if (request.mode == SetMode::Request::MAPPING) {
      slam_->resumeMapping();
      is_localization_wanted_ = false;
      response.success = true;
      response.message =
          isLocated(slam_->mode()) ? "mapping" : "mapping, as soon as the vehicle has found itself in the map";
    } else if (request.mode == SetMode::Request::LOCALIZATION) {
      try {
        slam_->localize();
        is_localization_wanted_ = true;
        response.success = true;
        response.message =
            isLocated(slam_->mode()) ? "localization" : "localization; the vehicle looks for itself in the map";
        publishMap();
      } catch (const std::logic_error&) {
        response.message = "there is no map yet that one could find oneself in; the node goes on mapping";
      }
    } else {
      response.message = "there is no mode " + std::to_string(request.mode) + "; 0 is mapping, 1 localization";
    }
    noteStatus();
  });
}

void SlamNode::expectAt(const geometry_msgs::PoseWithCovarianceStamped& message) {
  const Pose T_map_base = fromMessage(message.pose.pose);
  const double variance_m2 = std::max({0.0, message.pose.covariance[0], message.pose.covariance[7]});
  const auto& covariance = message.pose.covariance;
  const auto lock = lockCaughtUp();
  if (withoutSlash(message.header.frame_id) != config_.node.map_frame) {
    refuseInitialPose("it is in '" + message.header.frame_id + "', not in '" + config_.node.map_frame + "'");
  } else if (!T_map_base.isValid() || T_map_base.translation_m.cwiseAbs().maxCoeff() > kFarthest_m) {
    refuseInitialPose("it is not finite, far from anything on Earth, or its quaternion has no unit norm");
  } else if (!std::all_of(covariance.begin(), covariance.end(), [](double value) { return std::isfinite(value); })) {
    refuseInitialPose("its covariance is not finite");
  } else if (!slam_->expectAt(T_map_base, std::min(std::sqrt(variance_m2), kFarthest_m))) {
    refuseInitialPose("the node does not localize, or has no odometry yet");
  }
}

void SlamNode::refuseInitialPose(const std::string& problem) {
  ++estimator_.initial_poses_refused;
  estimator_.initial_pose_problem = problem;
  ROS_WARN_STREAM("initialpose is refused: " << problem);
  noteStatus();
}

ClockStatus SlamNode::clockStatus() {
  ClockStatus clock;
  clock.use_sim_time = ros::Time::isSimTime();
  const ros::Time now = ros::Time::now();
  const ros::WallTime wall_now = ros::WallTime::now();
  if (now != last_time_) last_time_change_ = wall_now;
  last_time_ = now;
  if (!now.isZero()) clock.time_s = now.toSec();
  clock.still_s = (wall_now - last_time_change_).toSec();
  return clock;
}

NodeStatus SlamNode::status() {
  const double now_s = ros::WallTime::now().toSec();
  NodeStatus status;
  status.odom_frame = config_.node.odom_frame;
  status.base_frame = config_.node.base_frame;
  status.class_table = config_.class_table;
  status.odometry_history_s = config_.slam.input.odometry_history_s;
  status.running_s = (ros::WallTime::now() - started_).toSec();
  status.clock = clockStatus();
  status.queue_length = queue_.length();
  status.queue_capacity = static_cast<std::size_t>(config_.node.queue_size);
  status.queue_dropped_odometry = queue_.droppedOdometry();
  status.queue_dropped_objects = queue_.droppedObjects();
  status.input_failures = input_failures_.status();
  status.other_failures = other_failures_.status();
  status.resident_mb = residentMegabytes();
  {
    const std::lock_guard<std::mutex> lock(status_mutex_);
    status.odometry = odometry_monitor_.status(now_s);
    status.objects = objects_monitor_.status(now_s);
    status.odometry.lost = odometry_gaps_.lost();
    status.objects.lost = objects_gaps_.lost();
    status.estimator = noted_estimator_;
    status.frame_times = frame_timer_.times();
  }
  status.odometry.topic = odometry_subscriber_.getTopic();
  status.odometry.publishers = odometry_subscriber_.getNumPublishers();
  status.objects.topic = objects_subscriber_.getTopic();
  status.objects.publishers = objects_subscriber_.getNumPublishers();
  return status;
}

}  // namespace semantic_mht_slam
