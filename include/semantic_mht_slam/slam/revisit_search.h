#pragma once

#include <vector>

#include "semantic_mht_slam/map/map.h"
#include "semantic_mht_slam/registration/registration.h"

namespace semantic_mht_slam {

/// How the surroundings of a keyframe are looked for in the earlier map near where the keyframe is believed to be.
struct RevisitConfig {
  bool enabled = true;
  Length min_driven_m{80.0};
  Length range_m{40.0};
  Length base_stddev_m{0.5};
  double base_stddev_rad = 0.01;
  Length max_stddev_m{8.0};
  double min_log_evidence = 12.0;
  double min_log_margin = 6.0;
  Length pair_distance_m{1.0};
};

void describe(RevisitConfig& config, Fields& fields);

/// How often the surroundings of a position were driven through: runs of successive keyframes within `radius_m`, seen
/// from above.
std::size_t passesAt(const Map& map, const Eigen::Vector3d& position_m, double radius_m);

/// What the pass that a keyframe belongs to saw around it, in the keyframe's axes.
Scene sceneAround(const Map& map, KeyframeId centre, const RevisitConfig& config);

/// Lays a scene onto what each pass saw near the pose that `prior` expects. One record for each pass that it might fit;
/// the query is no keyframe.
std::vector<LoopClosureRecord> findInMap(const Map& map, const Scene& scene, const RegistrationPrior& prior,
                                         const ClassTable& classes, const RegistrationConfig& registration,
                                         const RevisitConfig& config);

/// Lays what a keyframe sees onto what each earlier pass, at least `min_driven_m` before, saw near there, all at once,
/// with the drift since the last closure as prior (see `driftPrior`, `align`). One record for each pass that it might
/// fit.
std::vector<LoopClosureRecord> findRevisits(const Map& map, KeyframeId query, const RegistrationPrior& prior,
                                            const ClassTable& classes, const RegistrationConfig& registration,
                                            const RevisitConfig& config);

}  // namespace semantic_mht_slam
