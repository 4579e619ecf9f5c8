#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "semantic_mht_slam/app/recording.h"
#include "semantic_mht_slam/common/stamped_pose.h"

namespace semantic_mht_slam {

/// What of the input is odd though each message can be used; figures of the newest seconds, 0 before there are enough.
struct InputOddities {
  double speed_m_per_s = 0.0;  ///< median of the odometry's steps
  double range_m = 0.0;        ///< median horizontal distance of the objects
  double height_m = 0.0;       ///< median height of the objects above the base frame
  /// Share of the objects that are where one was from the robot before it had driven some metres, and share of those
  /// that are where one was in the world.
  double moving_along = 0.0;
  double standing = 0.0;

  bool isOdometryInMillimetres() const;
  bool areObjectsInMillimetres() const;
  bool areObjectsOnEnd() const;    ///< as in camera axes, whose z points ahead
  bool areObjectsInWorld() const;  ///< their coordinates do not change while the robot drives
};

/// Keeps the figures.
class InputPlausibility {
 public:
  void add(const StampedPose& T_odom_base);
  void add(const DetectorFrame& frame);  ///< base frame

  InputOddities look() const;

  /// Another odometry begins.
  void clear() { *this = InputPlausibility(); }

 private:
  void compare(const DetectorFrame& frame);

  std::optional<StampedPose> newest_;
  std::deque<double> speeds_m_per_s_;
  std::deque<double> ranges_m_;
  std::deque<double> heights_m_;
  std::vector<Eigen::Vector3d> before_m_;  ///< objects of a frame, in its base frame
  Pose T_odom_before_;
  std::deque<double> moving_along_;
  std::deque<double> standing_;
};

}  // namespace semantic_mht_slam
