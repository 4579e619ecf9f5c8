#pragma once

#include <map>
#include <string>

#include <ros/time.h>

namespace semantic_mht_slam {

/// Warnings on the log of ROS, each at most once in five seconds. Numbers in a text do not make it another one.
class ThrottledWarnings {
 public:
  void warn(const std::string& text) { warn(text, text); }

  /// The same for texts that differ in more than their numbers and are of one kind.
  void warn(const std::string& kind, const std::string& text);

 private:
  std::map<std::string, ros::WallTime> last_;  ///< by the kind without its numbers
};

}  // namespace semantic_mht_slam
