#pragma once

#include <vector>

#include "semantic_mht_slam/place/planar_scene.h"

namespace semantic_mht_slam {

/// Motion in the plane: p_match = R(yaw) (p_query - centre_query) + centre_match + shift.
struct PlanarGuess {
  double yaw_rad = 0.0;
  Eigen::Vector2d shift_m = Eigen::Vector2d::Zero();
  double votes = 0.0;
};

/// Guesses at how `query` lies on `match`: each pair of objects in the one that has a pair of the same classes and
/// length in the other votes for the motion between them, unless it takes the origin of the query further than
/// `max_offset_m` from that of the match. Most votes first, at most `count`; no two are neighbours.
std::vector<PlanarGuess> voteForMotions(const PlanarScene& query, const PlanarScene& match, double max_offset_m,
                                        int count);

}  // namespace semantic_mht_slam
