#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include <ros/time.h>

#include "semantic_mht_slam/ros/node_status.h"

namespace semantic_mht_slam {

/// Warnings on the console, each kind at most every 5 s of wall time: a clock that stands still is one of the things to
/// warn about.
class Warnings {
 public:
  /// Texts that differ in their numbers alone are of one kind.
  void warn(const std::string& text);

 private:
  std::map<std::string, ros::WallTime> last_warning_;  ///< by the text without its digits
};

/// What was dropped so far, a line for each cause.
std::vector<std::string> droppedInput(const EstimatorStatus& status, std::size_t queue_dropped,
                                      const std::string& odometry_topic, const std::string& objects_topic,
                                      const std::string& base_frame);

}  // namespace semantic_mht_slam
