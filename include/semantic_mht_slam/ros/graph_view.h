#pragma once

#include <vector>

#include <visualization_msgs/MarkerArray.h>

#include <semantic_mht_slam/LoopClosure.h>

#include "semantic_mht_slam/app/live_config.h"
#include "semantic_mht_slam/slam/slam.h"

namespace semantic_mht_slam {

/// The closures that were looked at since there were `first` of them, as messages.
std::vector<LoopClosure> toLoopClosures(const Slam& slam, std::size_t first, const std::string& map_frame);

/// Closures that are in the graph.
std::size_t acceptedClosures(const Slam& slam);

/// Closures as lines between the two keyframes: namespace `accepted` green; `refused`, if `live` asks for them, red.
visualization_msgs::MarkerArray toLoopMarkers(const Slam& slam, const LiveConfig& live, const std::string& map_frame);

/// The outline of each finished submap, a rectangle around its keyframes: grey, and orange for those that the newest
/// submap was compared with.
visualization_msgs::MarkerArray toSubmapMarkers(const Slam& slam, const std::string& map_frame);

/// The odometry as it came in, from the map's origin: what the trajectory would be without corrections.
visualization_msgs::MarkerArray toOdometryMarkers(const std::vector<Pose>& T_odom_base, const std::string& map_frame);

}  // namespace semantic_mht_slam
