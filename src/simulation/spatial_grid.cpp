#include "semantic_mht_slam/simulation/spatial_grid.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace semantic_mht_slam {

SpatialGrid::SpatialGrid(const std::vector<Eigen::Vector2d>& points_m, double cell_m)
    : points_m_(points_m), cell_m_(cell_m) {
  if (!(cell_m > 0.0)) throw std::invalid_argument("SpatialGrid: cell size not above 0");
  if (!points_m.empty()) {
    Eigen::Vector2d last = points_m.front();
    corner_m_ = points_m.front();
    for (const Eigen::Vector2d& point : points_m) {
      corner_m_ = corner_m_.cwiseMin(point);
      last = last.cwiseMax(point);
    }
    columns_ = static_cast<int>((last.x() - corner_m_.x()) / cell_m) + 1;
    rows_ = static_cast<int>((last.y() - corner_m_.y()) / cell_m) + 1;
  }
  cells_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
  for (std::size_t i = 0; i < points_m.size(); ++i) {
    const Eigen::Vector2d offset = points_m[i] - corner_m_;
    const int cell = cellOf(offset.y(), rows_) * columns_ + cellOf(offset.x(), columns_);
    cells_[static_cast<std::size_t>(cell)].push_back(static_cast<int>(i));
  }
}

int SpatialGrid::cellOf(double offset_m, int count) const {
  return static_cast<int>(std::clamp(std::floor(offset_m / cell_m_), 0.0, static_cast<double>(count - 1)));
}

std::vector<int> SpatialGrid::near(const Eigen::Vector2d& center_m, double radius_m) const {
  const Eigen::Vector2d offset = center_m - corner_m_;
  std::vector<int> found;
  for (int row = cellOf(offset.y() - radius_m, rows_); row <= cellOf(offset.y() + radius_m, rows_); ++row) {
    for (int column = cellOf(offset.x() - radius_m, columns_); column <= cellOf(offset.x() + radius_m, columns_);
         ++column) {
      for (const int i : cells_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                                static_cast<std::size_t>(column)]) {
        const Eigen::Vector2d difference = points_m_[static_cast<std::size_t>(i)] - center_m;
        if (difference.squaredNorm() <= radius_m * radius_m) found.push_back(i);
      }
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace semantic_mht_slam
