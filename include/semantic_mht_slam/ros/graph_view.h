#pragma once

#include <vector>

#include <visualization_msgs/MarkerArray.h>

#include <semantic_mht_slam/LoopClosure.h>

#include "semantic_mht_slam/app/live_config.h"
#include "semantic_mht_slam/map/map.h"

namespace semantic_mht_slam {

/// Which closures of a map have something to tell: they are new, or were accepted or refused since the last call.
class ClosureNews {
 public:
  std::vector<ClosureId> takeNews(const Map& map);

 private:
  IdVector<ClosureId, char> known_;  ///< whether each was accepted
};

/// Closures as messages.
std::vector<LoopClosure> toLoopClosures(const Map& map, const std::vector<ClosureId>& closures,
                                        const std::string& map_frame);

/// Closures that are in the graph.
std::size_t acceptedClosures(const Map& map);

/// What is drawn has sizes in `symbol_m`. Closures as lines between the two keyframes: namespace `accepted` green;
/// `refused`, if `live` asks for them, red.
visualization_msgs::MarkerArray toLoopMarkers(const Map& map, double symbol_m, const LiveConfig& live,
                                              const std::string& map_frame);

/// The outline of each finished submap, a rectangle around its keyframes: grey, and orange for those that the newest
/// submap was compared with.
visualization_msgs::MarkerArray toSubmapMarkers(const Map& map, double symbol_m, const std::string& map_frame);

/// The odometry as it came in, from the map's origin: what the trajectory would be without corrections.
visualization_msgs::MarkerArray toOdometryMarkers(const std::vector<Pose>& T_odom_base, double symbol_m,
                                                  const std::string& map_frame);

}  // namespace semantic_mht_slam
