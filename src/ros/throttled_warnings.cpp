#include "semantic_mht_slam/ros/throttled_warnings.h"

#include <algorithm>
#include <cctype>
#include <iterator>

#include <ros/console.h>

namespace semantic_mht_slam {
namespace {

constexpr double kBetweenWarnings_s = 5.0;
constexpr std::size_t kMostKinds = 1000;  // texts hold what others send: bounded memory

}  // namespace

void ThrottledWarnings::warn(const std::string& kind, const std::string& text) {
  std::string key;
  std::copy_if(kind.begin(), kind.end(), std::back_inserter(key), [](unsigned char c) { return std::isdigit(c) == 0; });
  if (last_.size() >= kMostKinds) last_.clear();
  ros::WallTime& last = last_[key];  // by wall time: a clock that stands still is one of the things to warn about
  const ros::WallTime now = ros::WallTime::now();
  if (now - last < ros::WallDuration(kBetweenWarnings_s)) return;
  last = now;
  ROS_WARN_STREAM(text);
}

}  // namespace semantic_mht_slam
