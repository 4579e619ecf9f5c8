#pragma once

#include <vector>

#include "semantic_mht_slam/place/scene_alignment.h"

#include "scene_votes.h"

namespace semantic_mht_slam {

/// Motion in the plane about the centres of both scenes, as in `PlanarGuess`, with what speaks for it.
struct PlanarFit {
  PlanarGuess motion;
  double quick_score = 0.0;
  std::vector<AlignedPair> pairs;  ///< indices of PlanarScene::objects
  double soft_inliers = 0.0;
  double static_inliers = 0.0;
  double similarity = 0.0;
  double log_evidence = 0.0;
  double log_static_evidence = 0.0;
};

/// Where the motion takes a point of the query.
Eigen::Vector2d moved(const PlanarGuess& motion, const PlanarScene& query, const PlanarScene& match,
                      const Eigen::Vector2d& point_m);

/// Moves the guess to the nearest optimum by iterated closest objects of the same class.
PlanarFit refineMotion(const PlanarScene& query, const PlanarScene& match, const PlanarGuess& guess,
                       const std::vector<bool>& is_static, const SceneAlignmentConfig& config);

/// Optimal one-to-one pairs, and the scores.
void judgeFit(const PlanarScene& query, const PlanarScene& match, const std::vector<bool>& is_static,
              const SceneAlignmentConfig& config, PlanarFit& fit);

}  // namespace semantic_mht_slam
