#pragma once

#include <string>

#include "semantic_mht_slam/app/recording.h"
#include "semantic_mht_slam/app/system_config.h"
#include "semantic_mht_slam/models/class_table.h"

namespace semantic_mht_slam {

/// Topics and frames of a recorded bag.
struct BagLayout {
  std::string objects_topic = "/objects";            ///< semantic_mht_slam/SemanticObjectArray
  std::string odometry_topic = "/odometry";          ///< nav_msgs/Odometry
  std::string fixes_topic;                           ///< sensor_msgs/NavSatFix; empty: /fix, if it holds such
  std::string ground_truth_topic = "/ground_truth";  ///< nav_msgs/Path, latched, T_map_base
  std::string time_origin_topic = "/time_origin";    ///< std_msgs/Time: the bag's time of stamp 0 of the data set
  std::string sensor_frame = "velodyne";
  std::string camera_frame = "cam0";
};

/// Writes a recording as a bag: objects, odometry, tf and tf_static, ground truth if known. An empty frame is written
/// as an empty array. ROS time cannot be 0, so every stamp is shifted by `time_origin`, which is stored in the bag. The
/// file appears under its name when it is complete. Throws InputError.
void writeBag(const std::string& path, const Recording& recording, const ClassTable& classes, const NodeConfig& frames,
              const BagLayout& layout, Stamp time_origin);

/// Reads a bag as a recording, as the node would receive it: by the same gates, in the order in which it was recorded.
/// What they refuse is counted in the recording. Stamps are shifted back by the stored time origin, if any.
/// Throws InputError for a missing, truncated or foreign file, missing topics (the others are named) and wrong message
/// types.
Recording readBag(const std::string& path, const ClassTable& classes, const NodeConfig& frames,
                  const BagLayout& layout);

}  // namespace semantic_mht_slam
