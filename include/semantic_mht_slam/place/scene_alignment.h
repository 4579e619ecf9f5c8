#pragma once

#include "semantic_mht_slam/map/scene.h"
#include "semantic_mht_slam/models/class_table.h"
#include "semantic_mht_slam/place/place_config.h"
#include "semantic_mht_slam/place/place_match.h"
#include "semantic_mht_slam/registration/registration.h"

namespace semantic_mht_slam {

/// How well two scenes lie on each other under one of the ways to lay the query onto the match.
struct SceneAlignment {
  RegistrationMode mode;  ///< a: match, b: query
  double soft_inliers =
      0.0;  ///< sum over the pairs of how well they lie on each other, in (0, 1], less for movable ones
  double static_inliers = 0.0;  ///< the same over objects that stay where they are
  double similarity = 0.0;      ///< squared soft inliers over the number of objects of the smaller scene
  double spread_m = 0.0;        ///< standard deviation of the pairs across the line that fits them best
  int pair_classes = 0;         ///< number of classes among the pairs
};

/// Ways to lay the objects of `query` onto those of `match`, without any prior (see `align`), most similar first.
/// About 0.2 ms a call for scenes of 30 objects.
std::vector<SceneAlignment> alignScenes(const Scene& query, const Scene& match, const ClassTable& classes,
                                        const RegistrationConfig& registration, const PlaceConfig& config);

/// The similarity of the best of them that is not the first one seen a little differently; -1 if there is none.
double rivalSimilarity(const std::vector<SceneAlignment>& alignments, const PlaceConfig& config);

/// Checks of an alignment that need nothing else; `rival_score` is that of the next distinct one, -1 without any.
PlaceRefusal checkAlignment(const SceneAlignment& alignment, double rival_score, const PlaceConfig& config);

}  // namespace semantic_mht_slam
