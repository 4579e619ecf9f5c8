#pragma once

#include "semantic_mht_slam/place/scene_alignment.h"

#include "scene_fit.h"

namespace semantic_mht_slam {

/// The fit as a transform in space with covariance: Gauss-Newton steps over the pairs, all six parameters; roll and
/// pitch between the keyframes are near zero unless heights tell otherwise.
SceneAlignment toAlignment(const PlanarScene& query, const PlanarScene& match, const PlanarFit& fit,
                           const SceneAlignmentConfig& config);

}  // namespace semantic_mht_slam
