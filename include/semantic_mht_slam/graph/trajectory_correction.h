#pragma once

#include <cstddef>
#include <vector>

#include "semantic_mht_slam/common/pose.h"

namespace semantic_mht_slam {

/// A moment of the drive where the graph corrected the pose: the origin of a node.
struct CorrectionAnchor {
  std::size_t index = 0;  ///< position in the list of odometry poses
  Pose T_map_base;        ///< corrected pose at that moment
};

/// Carries the corrections at node origins over to every odometry pose. Between two anchors the pose is blended from
/// what odometry says forwards from the first and backwards from the second, in proportion to the distance travelled
/// (to the index where the vehicle stood still), so that the trajectory meets every anchor and has no steps. Before the
/// first and behind the last anchor odometry is attached rigidly.
///
/// `odometry` are poses T_odom_base in order of time; anchors have ascending indices. Throws std::invalid_argument
/// without an anchor, or for an index that is out of range or not ascending.
std::vector<Pose> correctTrajectory(const std::vector<Pose>& odometry, const std::vector<CorrectionAnchor>& anchors);

}  // namespace semantic_mht_slam
