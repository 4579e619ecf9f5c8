#pragma once

#include <atomic>
#include <mutex>
#include <optional>
#include <vector>

#include <ros/ros.h>
#include <tf2_ros/transform_broadcaster.h>

#include <semantic_mht_slam/SemanticMap.h>

#include "semantic_mht_slam/app/system_config.h"
#include "semantic_mht_slam/models/class_table.h"
#include "semantic_mht_slam/ros/correction_policy.h"
#include "semantic_mht_slam/ros/graph_view.h"
#include "semantic_mht_slam/ros/map_updates.h"
#include "semantic_mht_slam/slam/slam.h"

namespace semantic_mht_slam {

/// What the node tells the world: tf `map -> odom`, `pose`, `hypotheses`, `map`, `loop_closures`, `trajectory` and
/// `markers/*`. The
/// caller sees to it that the estimator does not change meanwhile.
class SlamPublisher {
 public:
  SlamPublisher(ros::NodeHandle handle, const NodeConfig& config, const ClassTable& classes);

  /// tf and pose of the newest odometry sample, with the correction that the policy allows; the covariance holds what
  /// the policy holds back.
  void publishPose(const Slam& slam, const LiveConfig& live);

  /// tf and pose of an odometry sample with the newest correction that was published: the estimator is not asked, and
  /// may be at work in another thread. Does nothing before the first pose of a map, or while the pose is unknown.
  void publishDeadReckoning(const StampedPose& T_odom_base, const LiveConfig& live);

  /// The pose is not known from now on until it is published again; its stamps may be earlier then.
  void forgetPose();

  /// Objects and hypotheses of the newest frame if it is a new one, and the map if a submap was finished.
  void publishFrame(const Slam& slam, const LiveConfig& live);

  /// What is to be explained of the detections: nothing while nobody listens.
  ExplainLimits wantedExplanations() const;

  /// Detections of the submaps that ended whose landmarks are not sure. Takes them from `slam`.
  void publishAmbiguous(Slam& slam);

  /// The landmarks of the finished submaps.
  void publishMap(const Slam& slam, const LiveConfig& live);

  /// Landmarks of the newest map, loop closures and submaps once more, drawn as `live` says.
  void publishMapMarkers(const Slam& slam, const LiveConfig& live);

  /// Who holds it publishes the next trajectory.
  using TrajectoryTurn = std::unique_lock<std::mutex>;

  /// Waits for the trajectory that is being published.
  TrajectoryTurn takeTrajectoryTurn() { return TrajectoryTurn(trajectory_mutex_); }

  /// Also what the odometry alone says, from `odometry`. The estimator may change meanwhile, for whoever took the turn
  /// before that.
  void publishTrajectory(const TrajectoryTurn& turn, const std::vector<StampedPose>& trajectory,
                         const std::vector<Pose>& T_odom_base);

  /// T_odom_base about once a metre, thinned as it is published.
  std::vector<Pose> odometry() const;

  /// A new map begins with `slam`: empties what is latched.
  void startAgain(const Slam& slam);

  /// A loaded map takes the place of the one before.
  void showLoaded(const Slam& slam, const LiveConfig& live);

  /// What others may have missed of `map_update`.
  const MapUpdates& updates() const { return updates_; }

  /// What the topic `map` shows.
  const SemanticMap& map() const { return shown_; }

  /// Landmarks of the newest published map, without provisional ones.
  std::size_t landmarks() const { return map_.landmarks.size(); }

  /// Loop closures in it.
  std::size_t loops() const { return loops_; }

 private:
  void publishProvisional(const Slam& slam, const LiveConfig& live);
  void sendPose(Stamp stamp, const Pose& T_odom_base, const LiveConfig& live);

  std::mutex pose_mutex_;  ///< guards what `sendPose` needs

  const NodeConfig config_;
  const ClassTable classes_;
  MapUpdates updates_;
  tf2_ros::TransformBroadcaster transform_broadcaster_;
  ros::Publisher pose_publisher_;
  ros::Publisher trajectory_publisher_;
  ros::Publisher objects_publisher_;
  ros::Publisher landmarks_publisher_;
  ros::Publisher loops_publisher_;
  ros::Publisher submaps_publisher_;
  ros::Publisher odometry_publisher_;
  ros::Publisher closures_publisher_;
  ros::Publisher hypotheses_publisher_;
  ros::Publisher map_publisher_;
  ros::Publisher ambiguous_publisher_;
  CorrectionFollower correction_;
  std::optional<Pose> T_map_odom_;   ///< of the newest pose
  std::optional<Stamp> pose_stamp_;  ///< of the newest pose; none goes out that is not newer
  UncertainPose latest_;
  OdometryModel odometry_model_;
  std::optional<Stamp> published_frame_;
  std::size_t published_submaps_ = 0;
  ClosureNews closures_;
  std::size_t loops_ = 0;
  std::vector<Pose> odometry_;
  std::mutex trajectory_mutex_;
  SemanticMap map_;                     ///< of the finished submaps
  SemanticMap shown_;                   ///< with what the open submap adds
  std::atomic<double> symbol_m_ = 1.0;  ///< size of what is drawn without a size of its own
  ros::WallTime next_provisional_;
};

}  // namespace semantic_mht_slam
