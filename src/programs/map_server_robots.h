#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <ros/ros.h>

#include <semantic_mht_slam/MapUpdate.h>

#include "semantic_mht_slam/ros/throttled_warnings.h"
#include "semantic_mht_slam/slam/map_delta.h"

#include "map_server_maps.h"

namespace semantic_mht_slam {

/// The map of one robot, by its `map_update`; what is missing is asked for by its service `get_map_updates`.
class RobotFeed {
 public:
  /// @param robot namespace of its node
  RobotFeed(ros::NodeHandle handle, const std::string& robot, SlamConfig config, ClassTable classes,
            std::function<void()> on_news);

  /// Asks the robot for what is missing, if anything is, or if it has not been asked for a while.
  void catchUp();

  /// Puts the map into the list if it has changed.
  void takeNews(ServedMaps& maps);

 private:
  void take(const MapUpdate& update);
  void requireMap(std::uint64_t map_id);

  const std::string name_;
  const std::string topic_;
  const std::string service_;
  const SlamConfig config_;
  const ClassTable classes_;
  const std::function<void()> on_news_;
  std::mutex mutex_;  ///< guards all below
  std::uint64_t map_id_ = 0;
  std::string frame_;
  MapByDeltas map_;
  bool has_changed_ = false;
  bool begins_anew_ = false;
  bool has_gap_ = true;
  std::string problem_;
  ros::WallTime next_question_;
  ThrottledWarnings warnings_;
  ros::Subscriber subscriber_;
};

}  // namespace semantic_mht_slam
