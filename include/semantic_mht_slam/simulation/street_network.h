#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "semantic_mht_slam/common/random.h"
#include "semantic_mht_slam/simulation/scenario.h"

namespace semantic_mht_slam {

enum class StreetType { kResidential, kMain, kGreen };

/// A street between two corners.
struct Street {
  int from = 0;  ///< node where the centre line begins
  int to = 0;
  StreetType type = StreetType::kResidential;
  int lookalike_of = -1;                       ///< the parallel street whose objects it repeats, or -1
  std::vector<Eigen::Vector2d> center_line_m;  ///< world frame, about 1 m between points
  double length_m = 0.0;
};

/// Place on a street: a point of the centre line and the direction of the street there.
struct StreetPoint {
  Eigen::Vector2d position_m;
  Eigen::Vector2d direction;  ///< unit vector
};

/// Ground as a sum of plane waves, so that height and slope are known everywhere.
struct Terrain {
  struct Wave {
    Eigen::Vector2d wave_vector_rad_per_m;
    double phase_rad = 0.0;
    double amplitude_m = 0.0;
  };
  std::array<Wave, 4> waves;

  double height(const Eigen::Vector2d& position_m) const;
  Eigen::Vector2d gradient(const Eigen::Vector2d& position_m) const;
};

/// Streets of a town in a world frame (x east, y north, z up; metres).
struct StreetNetwork {
  std::vector<Eigen::Vector2d> nodes_m;
  std::vector<Street> streets;
  Terrain terrain;

  double totalLength() const;
};

/// Draws a connected network in which every corner has at least two streets.
StreetNetwork buildStreetNetwork(const StreetNetworkConfig& config, Rng rng);

/// The point `along_m` metres from the beginning of the street; held at its ends.
StreetPoint pointOnStreet(const Street& street, double along_m);

/// Left of a direction in the plane.
inline Eigen::Vector2d leftOf(const Eigen::Vector2d& direction) {
  return {-direction.y(), direction.x()};
}

}  // namespace semantic_mht_slam
