#pragma once

#include "semantic_mht_slam/common/config.h"

namespace semantic_mht_slam {

/// How first guesses at the motion between two sets of points are found.
enum class RegistrationSearch {
  kVotes,   ///< points, or without a prior pairs of points, vote for motions
  kClique,  ///< largest set of correspondences that keep their distances
  kRansac,  ///< random samples of three correspondences (PCL)
};

/// Parameters of `align`, for all who lay points onto points.
struct RegistrationConfig {
  RegistrationSearch search = RegistrationSearch::kVotes;
  Length max_offset_m{7.5};
  double window_sigmas = 3.0;
  Length max_window_m{30.0};
  Length cell_m{0.5};
  double yaw_step_rad = 0.0175;
  int max_seeds = 10;
  int max_modes = 5;
  int min_matches = 3;
  double static_match_prob = 0.9;
  double movable_match_prob = 0.7;
  double match_concentration = 5.0;
  double confusion_prob = 0.05;
  Length noise_floor_m{0.15};
  Length height_stddev_m{0.3};
  double tilt_stddev_rad = 0.02;
  Length density_radius_m{10.0};
  Length density_height_m{3.0};
  Length distinct_m{0.5};
  double distinct_rad = 0.01;
};

void describe(RegistrationConfig& config, Fields& fields);

}  // namespace semantic_mht_slam
