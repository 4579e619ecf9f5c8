#pragma once

#include <vector>

#include <Eigen/Core>

namespace semantic_mht_slam {

/// Finds the points of the plane near a place. Immutable.
class SpatialGrid {
 public:
  /// `cell_m` > 0, best near the radii asked for; else std::invalid_argument.
  SpatialGrid(const std::vector<Eigen::Vector2d>& points_m, double cell_m);

  /// Indices of the points at most `radius_m` away, ascending.
  std::vector<int> near(const Eigen::Vector2d& center_m, double radius_m) const;

 private:
  int cellOf(double offset_m, int count) const;

  std::vector<Eigen::Vector2d> points_m_;
  double cell_m_;
  Eigen::Vector2d corner_m_ = Eigen::Vector2d::Zero();
  int columns_ = 1;
  int rows_ = 1;
  std::vector<std::vector<int>> cells_;  // row by row
};

}  // namespace semantic_mht_slam
