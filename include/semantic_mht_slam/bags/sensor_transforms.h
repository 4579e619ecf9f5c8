#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <ros/time.h>
#include <tf2/buffer_core.h>

#include "semantic_mht_slam/app/system_config.h"
#include "semantic_mht_slam/common/stamped_pose.h"

namespace semantic_mht_slam {

/// A frame name as tf2 takes it: older packages write a slash before it.
std::string withoutSlash(const std::string& frame);

/// Where a frame was at a stamp, as far as one knows.
struct SensorPlace {
  enum class Answer {
    kKnown,
    kMayCome,  ///< tf or odometry that tells has not come, or never will
    kInMap     ///< it hangs on the map, which is what is sought
  };
  Answer answer = Answer::kMayCome;
  Pose T_base_sensor = Pose::identity();
  bool is_by_odometry = false;  ///< the frame does not move with the robot
};

/// Where objects were seen from. A sensor may be on /tf_static or on /tf, and may move on the robot; a frame that hangs
/// on the odometry's, not on the robot, is placed by the odometry at the stamp.
class SensorTransforms {
 public:
  /// `transforms` holds what tf says; it may be filled by another thread.
  SensorTransforms(const tf2::BufferCore& transforms, const NodeConfig& frames);

  /// Odometry that is used, in its order.
  void addOdometry(const StampedPose& T_odom_base);

  /// Another odometry begins.
  void forgetOdometry() { odometry_.clear(); }

  /// A sensor that was at the same place on the robot at two stamps is where it was last, until it is seen to move.
  SensorPlace find(const std::string& frame, Stamp stamp);

  /// For objects that have waited for long enough: the newest place of a sensor that was not seen to move.
  std::optional<Pose> findNewest(const std::string& frame);

 private:
  enum class Side { kRobot, kOdometry, kMap };

  struct Seen {
    Pose T_base_sensor;
    ros::Time first;          ///< stamp for which it was known first
    bool is_settled = false;  ///< it is not waited for any more
    bool moves = false;
  };

  std::vector<std::string> ancestors(std::string frame) const;
  Side sideOf(const std::string& frame) const;
  SensorPlace onRobot(const std::string& frame, const ros::Time& time);
  SensorPlace inOdometry(const std::string& frame, const ros::Time& time) const;
  Seen& note(const std::string& frame, const Pose& T_base_sensor, const ros::Time& time);

  const tf2::BufferCore& transforms_;
  const std::string map_frame_;
  const std::string odom_frame_;
  const std::string base_frame_;
  tf2::BufferCore odometry_;
  std::map<std::string, Seen> seen_;
};

}  // namespace semantic_mht_slam
