#include "semantic_mht_slam/ros/slam_publisher.h"

#include <algorithm>
#include <stdexcept>

#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <nav_msgs/Path.h>
#include <visualization_msgs/MarkerArray.h>

#include "semantic_mht_slam/bags/conversions.h"
#include "semantic_mht_slam/ros/ambiguity_description.h"
#include "semantic_mht_slam/ros/graph_view.h"
#include "semantic_mht_slam/ros/markers.h"
#include "semantic_mht_slam/ros/thinned.h"

namespace semantic_mht_slam {
namespace {

constexpr double kOdometrySpacing_m = 1.0;
constexpr double kProvisionalShare = 50.0;   // of the time that making it takes, before it is made again
constexpr double kProvisionalPause_s = 1.0;  // a map of a town is a large message
constexpr std::uint32_t kAmbiguousQueue = 10;
constexpr std::uint32_t kClosureQueue = 1000;  // a submap may look at many

/// Covariance of a pose that is believed elsewhere than where it is said to be: by as much it is off on purpose.
FixedAxesCov withGap(const FixedAxesCov& cov, const Pose& believed, const Pose& said) {
  Eigen::Matrix<double, 6, 1> gap;
  gap << believed.translation_m - said.translation_m, logRotation(believed.rotation * said.rotation.conjugate());
  return cov + gap * gap.transpose();
}

}  // namespace

SlamPublisher::SlamPublisher(ros::NodeHandle handle, const NodeConfig& config, const ClassTable& classes)
    : config_(config),
      classes_(classes),
      updates_(handle, config.map_frame, classes),
      pose_publisher_(handle.advertise<geometry_msgs::PoseWithCovarianceStamped>("pose", 100)),
      trajectory_publisher_(handle.advertise<nav_msgs::Path>("trajectory", 1, true)),
      objects_publisher_(handle.advertise<visualization_msgs::MarkerArray>("markers/objects", 10, true)),
      landmarks_publisher_(handle.advertise<visualization_msgs::MarkerArray>("markers/landmarks", 2, true)),
      loops_publisher_(handle.advertise<visualization_msgs::MarkerArray>("markers/loops", 2, true)),
      submaps_publisher_(handle.advertise<visualization_msgs::MarkerArray>("markers/submaps", 2, true)),
      odometry_publisher_(handle.advertise<visualization_msgs::MarkerArray>("markers/odometry", 2, true)),
      closures_publisher_(handle.advertise<LoopClosure>("loop_closures", kClosureQueue)),
      hypotheses_publisher_(handle.advertise<HypothesisTree>("hypotheses", 10)),
      map_publisher_(handle.advertise<SemanticMap>("map", 1, true)),
      ambiguous_publisher_(handle.advertise<AmbiguousDetections>("ambiguous_detections", kAmbiguousQueue)),
      map_(toMessage(0, config.map_frame, classes, {}, 0)),
      shown_(map_) {}

void SlamPublisher::publishPose(const Slam& slam, const LiveConfig& live) {
  const std::lock_guard<std::mutex> lock(pose_mutex_);
  const StampedPose latest = *latestPoseOf(slam);
  T_map_odom_ = slam.T_map_odom();
  odometry_model_ = slam.parts().odometry;
  latest_ = UncertainPose{latest.T_world_base, latestCovOf(slam).value_or(unknownPoseCov())};
  const Pose T_odom_base = T_map_odom_->inverse() * latest.T_world_base;
  if (odometry_.empty() || (odometry_.back().translation_m - T_odom_base.translation_m).norm() > kOdometrySpacing_m) {
    odometry_.push_back(T_odom_base);
  }
  sendPose(latest.stamp, T_odom_base, live);
}

void SlamPublisher::publishDeadReckoning(const StampedPose& T_odom_base, const LiveConfig& live) {
  const std::lock_guard<std::mutex> lock(pose_mutex_);
  if (!T_map_odom_) return;
  const Pose T_map_base = *T_map_odom_ * T_odom_base.T_world_base;
  latest_ = reckoned(latest_, latest_.T_world_base.inverse() * T_map_base, odometry_model_);
  latest_.T_world_base = T_map_base;
  sendPose(T_odom_base.stamp, T_odom_base.T_world_base, live);
}

void SlamPublisher::forgetPose() {
  const std::lock_guard<std::mutex> lock(pose_mutex_);
  correction_.reset();
  T_map_odom_.reset();
  pose_stamp_.reset();
}

/// The newest pose.
void SlamPublisher::sendPose(Stamp stamp, const Pose& T_odom_base, const LiveConfig& live) {
  if (pose_stamp_ && stamp <= *pose_stamp_) return;  // went out before, by odometry alone
  pose_stamp_ = stamp;
  const Pose followed = correction_.follow(*T_map_odom_, T_odom_base, stamp, live);
  if (config_.publishes_tf) {
    transform_broadcaster_.sendTransform(toTransform({stamp, followed}, config_.map_frame, config_.odom_frame));
  }
  geometry_msgs::PoseWithCovarianceStamped message;
  message.header.stamp = toRosTime(stamp);
  message.header.frame_id = config_.map_frame;
  const Pose& believed = latest_.T_world_base;
  const bool is_there = live.correction == CorrectionPolicy::kJump;
  const Pose said = is_there ? believed : followed * T_odom_base;
  message.pose = toMessage(said, is_there ? latest_.total() : withGap(latest_.total(), believed, said));
  pose_publisher_.publish(message);
}

void SlamPublisher::publishFrame(const Slam& slam, const LiveConfig& live) {
  const std::optional<Frame>& frame = slam.parts().latest_frame;
  if (!frame || frame->stamp == published_frame_) return;
  published_frame_ = frame->stamp;
  objects_publisher_.publish(toObjectMarkers(*frame, slam.T_map_odom(), classes_, symbol_m_, config_.map_frame));
  if (hypothesesOf(slam).empty()) return;
  hypotheses_publisher_.publish(
      toMessage(*frame, config_.map_frame, slam.parts().mapper->submap(), hypothesesOf(slam)));
  slam.map().submaps().size() != published_submaps_ ? publishMap(slam, live) : publishProvisional(slam, live);
}

ExplainLimits SlamPublisher::wantedExplanations() const {
  if (ambiguous_publisher_.getNumSubscribers() == 0) return {};
  return {config_.ambiguous_below_prob, static_cast<std::size_t>(config_.ambiguous_most)};
}

void SlamPublisher::publishAmbiguous(Slam& slam) {
  for (const UnsureDetections& unsure : slam.takeUnsure()) {
    ambiguous_publisher_.publish(toAmbiguousDetections(unsure, slam.map(), classes_, config_.map_frame));
  }
}

void SlamPublisher::publishMap(const Slam& slam, const LiveConfig& live) {
  published_submaps_ = slam.map().submaps().size();
  const Stamp stamp = slam.parts().latest_frame ? slam.parts().latest_frame->stamp : 0;
  map_ = toMessage(stamp, config_.map_frame, classes_, landmarksOf(slam), published_submaps_);
  shown_ = map_;
  symbol_m_ = symbolSize(slam.parts().range_factor, map_);
  map_publisher_.publish(map_);
  const std::vector<ClosureId> news = closures_.takeNews(slam.map());
  for (const LoopClosure& closure : toLoopClosures(slam.map(), news, config_.map_frame)) {
    closures_publisher_.publish(closure);
  }
  loops_ = acceptedClosures(slam.map());
  publishMapMarkers(slam, live);
  updates_.publishNew(slam);
}

void SlamPublisher::publishProvisional(const Slam& slam, const LiveConfig& live) {
  const ros::WallTime now = ros::WallTime::now();
  if (now < next_provisional_) return;
  const std::vector<MixtureLandmark> news = provisionalLandmarksOf(slam);
  if (news.empty() && shown_.landmarks.size() == map_.landmarks.size()) return;
  shown_ = map_;
  shown_.header.stamp = toRosTime(slam.parts().latest_frame->stamp);
  for (const MixtureLandmark& landmark : news) {
    shown_.landmarks.push_back(toMessage(landmark, classes_));
    shown_.landmarks.back().provisional = true;
  }
  std::sort(shown_.landmarks.begin(), shown_.landmarks.end(),
            [](const Landmark& a, const Landmark& b) { return a.id < b.id; });
  symbol_m_ = symbolSize(slam.parts().range_factor, shown_);
  map_publisher_.publish(shown_);
  landmarks_publisher_.publish(toLandmarkMarkers(shown_, classes_, symbol_m_, live));
  const ros::WallTime end = ros::WallTime::now();
  next_provisional_ = end + ros::WallDuration(std::max(kProvisionalPause_s, kProvisionalShare * (end - now).toSec()));
}

void SlamPublisher::publishMapMarkers(const Slam& slam, const LiveConfig& live) {
  landmarks_publisher_.publish(toLandmarkMarkers(shown_, classes_, symbol_m_, live));
  loops_publisher_.publish(toLoopMarkers(slam.map(), symbol_m_, live, config_.map_frame));
  submaps_publisher_.publish(toSubmapMarkers(slam.map(), symbol_m_, config_.map_frame));
}

void SlamPublisher::publishTrajectory(const TrajectoryTurn& turn, const std::vector<StampedPose>& trajectory,
                                      const std::vector<Pose>& T_odom_base) {
  if (!turn.owns_lock()) throw std::logic_error("SlamPublisher: a trajectory is published by who has the turn");
  const auto most = static_cast<std::size_t>(config_.trajectory_poses);
  trajectory_publisher_.publish(toPath(thinned(trajectory, most), config_.map_frame));
  odometry_publisher_.publish(toOdometryMarkers(T_odom_base, symbol_m_, config_.map_frame));
}

std::vector<Pose> SlamPublisher::odometry() const {
  return thinned(odometry_, static_cast<std::size_t>(config_.trajectory_poses));
}

void SlamPublisher::startAgain(const Slam& slam) {
  forgetPose();
  published_frame_.reset();
  published_submaps_ = 0;
  closures_ = {};
  loops_ = 0;
  odometry_.clear();
  updates_.startAgain();
  map_ = toMessage(0, config_.map_frame, classes_, {}, 0);
  shown_ = map_;
  map_publisher_.publish(map_);
  publishMapMarkers(slam, {});
  publishTrajectory(takeTrajectoryTurn(), {}, {});
  hypotheses_publisher_.publish(toMessage(Frame{}, config_.map_frame, SubmapId(0), {}));
}

void SlamPublisher::showLoaded(const Slam& slam, const LiveConfig& live) {
  startAgain(slam);
  closures_.takeNews(slam.map());  // were published long ago
  publishMap(slam, live);
}

}  // namespace semantic_mht_slam
