#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include <ros/ros.h>

#include <semantic_mht_slam/GetMapUpdates.h>
#include <semantic_mht_slam/MapUpdate.h>

#include "semantic_mht_slam/models/class_table.h"
#include "semantic_mht_slam/slam/slam.h"

namespace semantic_mht_slam {

/// What a node tells others of its map, submap by submap: topic `map_update`, and what somebody has missed of it.
class MapUpdates {
 public:
  MapUpdates(ros::NodeHandle& handle, std::string map_frame, const ClassTable& classes);

  /// The submaps that were finished since the last call.
  void publishNew(const Slam& slam);

  /// Another map begins.
  void startAgain();

  /// The submaps from `request.first` on, if that is of this map, else from the first on; not too many at once.
  void answer(const GetMapUpdates::Request& request, GetMapUpdates::Response& response, const Slam& slam) const;

 private:
  MapUpdate updateOf(const Slam& slam, SubmapId submap) const;

  const std::string map_frame_;
  const ClassTable classes_;
  ros::Publisher publisher_;
  std::uint64_t map_id_;
  std::size_t published_ = 0;
};

}  // namespace semantic_mht_slam
