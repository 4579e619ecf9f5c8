#pragma once

#include <string>

#include <geometry_msgs/Pose.h>
#include <geometry_msgs/PoseWithCovariance.h>
#include <geometry_msgs/TransformStamped.h>
#include <nav_msgs/Odometry.h>
#include <nav_msgs/Path.h>
#include <ros/time.h>

#include <semantic_mht_slam/HypothesisTree.h>
#include <semantic_mht_slam/SemanticMap.h>
#include <semantic_mht_slam/SemanticObjectArray.h>

#include "semantic_mht_slam/common/pose_cov.h"
#include "semantic_mht_slam/common/stamped_pose.h"
#include "semantic_mht_slam/map/landmark.h"
#include "semantic_mht_slam/mapping/hypothesis.h"
#include "semantic_mht_slam/models/class_table.h"
#include "semantic_mht_slam/models/detection.h"
#include "semantic_mht_slam/models/frame.h"

namespace semantic_mht_slam {

ros::Time toRosTime(Stamp stamp);
Stamp toStamp(const ros::Time& time);

geometry_msgs::Pose toMessage(const Pose& pose);

/// A pose with its covariance, which is in the axes of its parent.
geometry_msgs::PoseWithCovariance toMessage(const Pose& pose, const FixedAxesCov& cov);

/// Quaternions that are not normalised are normalised; a zero quaternion or a number that is not finite stays as it is
/// and makes the pose invalid.
Pose fromMessage(const geometry_msgs::Pose& message);
Pose fromMessage(const geometry_msgs::Transform& message);

geometry_msgs::TransformStamped toTransform(const StampedPose& T_parent_child, const std::string& parent,
                                            const std::string& child);

nav_msgs::Odometry toOdometry(const StampedPose& T_odom_base, const std::string& odom_frame,
                              const std::string& base_frame);

nav_msgs::Path toPath(const std::vector<StampedPose>& T_map_base, const std::string& map_frame);

/// Detections in a sensor frame as a message.
SemanticObjectArray toMessage(Stamp stamp, const std::string& sensor_frame, const Detections& detections,
                              const ClassTable& classes);

/// Detections of a message in the base frame; 0, 0, 0 of the sensor, which is no place, stays 0, 0, 0. Extents stay
/// along the sensor's axes. Objects whose class id the table lacks are left out and counted in `unknown_classes`; `row`
/// keeps the place in the message.
Detections fromMessage(const SemanticObjectArray& message, const ClassTable& classes, const Pose& T_base_sensor,
                       std::size_t& unknown_classes);

/// A landmark in the frame of the map.
Landmark toMessage(const MixtureLandmark& landmark, const ClassTable& classes);

/// Landmarks in `map_frame` with the class table.
SemanticMap toMessage(Stamp stamp, const std::string& map_frame, const ClassTable& classes,
                      const std::vector<MixtureLandmark>& landmarks, std::size_t submaps);

/// The leaves of the current submap's tree, most likely first.
HypothesisTree toMessage(const Frame& frame, const std::string& map_frame, SubmapId submap,
                         const std::vector<MapHypothesis>& leaves);

}  // namespace semantic_mht_slam
