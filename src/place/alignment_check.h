#pragma once

#include "semantic_mht_slam/place/place_config.h"
#include "semantic_mht_slam/place/place_match.h"
#include "semantic_mht_slam/place/scene_alignment.h"

namespace semantic_mht_slam {

/// Checks of an alignment that need nothing else; `rival_score` is that of the next distinct one, -1 without any.
PlaceRefusal checkAlignment(const SceneAlignment& alignment, double rival_score, const PlaceConfig& config);

}  // namespace semantic_mht_slam
