#include "semantic_mht_slam/evaluation/planar_grid.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <tuple>

namespace semantic_mht_slam {

PlanarGrid::PlanarGrid(const std::vector<Eigen::Vector2d>& points_m, double cell_m) : cell_m_(cell_m) {
  if (!(cell_m > 0.0) || !std::isfinite(cell_m))
    throw std::invalid_argument("PlanarGrid: the cell size is not positive");
  entries_.reserve(points_m.size());
  for (std::size_t i = 0; i < points_m.size(); ++i) entries_.push_back({cellOf(points_m[i]), i});
  std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
    return std::tie(a.cell.x, a.cell.y, a.index) < std::tie(b.cell.x, b.cell.y, b.index);
  });
}

PlanarGrid::Cell PlanarGrid::cellOf(const Eigen::Vector2d& point_m) const {
  const Eigen::Vector2d cell = point_m / cell_m_;
  if (!(cell.cwiseAbs().maxCoeff() < 1e15) || !cell.allFinite()) {
    throw std::invalid_argument("PlanarGrid: a coordinate is not finite or too large");
  }
  return {static_cast<std::int64_t>(std::floor(cell.x())), static_cast<std::int64_t>(std::floor(cell.y()))};
}

PlanarGrid::Range PlanarGrid::rowsOfColumn(std::int64_t column, std::int64_t first_row, std::int64_t last_row) const {
  const auto before = [](const Entry& entry, const Cell& cell) {
    return std::tie(entry.cell.x, entry.cell.y) < std::tie(cell.x, cell.y);
  };
  const auto begin = std::lower_bound(entries_.begin(), entries_.end(), Cell{column, first_row}, before);
  const auto end = std::lower_bound(begin, entries_.end(), Cell{column, last_row + 1}, before);
  return {static_cast<std::size_t>(begin - entries_.begin()), static_cast<std::size_t>(end - entries_.begin())};
}

}  // namespace semantic_mht_slam
