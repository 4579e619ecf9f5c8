#pragma once

#include <vector>

#include "semantic_mht_slam/map/map.h"
#include "semantic_mht_slam/registration/registration.h"

namespace semantic_mht_slam {

/// How the surroundings of a keyframe are looked for in the earlier map near where the keyframe is believed to be.
struct RevisitConfig {
  bool enabled = true;
  double min_driven_m = 80.0;
  double range_m = 40.0;
  double base_stddev_m = 0.5;
  double base_stddev_rad = 0.01;
  double drift_per_m = 0.015;
  double drift_rad_per_sqrt_m = 0.001;
  double max_stddev_m = 8.0;
  double min_log_evidence = 12.0;
  double min_log_margin = 6.0;
  double pair_distance_m = 1.0;
};

void describe(RevisitConfig& config, Fields& fields);

/// How often the surroundings of a position were driven through: runs of successive keyframes within 10 m, seen from
/// above.
std::size_t passesAt(const Map& map, const Eigen::Vector3d& position_m);

/// How far the pose may be off from the earlier map after `drifted_m` of driving since it was last tied to it; in the
/// frame of `T_map_base`.
RegistrationPrior driftPrior(const Pose& T_map_base, double drifted_m, const RevisitConfig& config);

/// Lays a scene onto what each pass saw near the pose that `prior` expects. One record for each pass that it might fit;
/// the query is no keyframe.
std::vector<LoopClosureRecord> findInMap(const Map& map, const Scene& scene, const RegistrationPrior& prior,
                                         const ClassTable& classes, const RegistrationConfig& registration,
                                         const RevisitConfig& config);

/// Lays what a keyframe sees onto what each earlier pass, at least `min_driven_m` before, saw near there, all at once,
/// with the drift since the last closure as prior (see `align`). One record for each pass that it might fit.
/// `drifted_m` was driven since the pose was last tied to the earlier map.
std::vector<LoopClosureRecord> findRevisits(const Map& map, KeyframeId query, double drifted_m,
                                            const ClassTable& classes, const RegistrationConfig& registration,
                                            const RevisitConfig& config);

}  // namespace semantic_mht_slam
