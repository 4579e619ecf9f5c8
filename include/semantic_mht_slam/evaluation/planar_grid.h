#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace semantic_mht_slam {

/// Points of the plane, sorted into square cells, so that the neighbours of a place are found without looking at every
/// point. Immutable.
class PlanarGrid {
 public:
  /// Throws std::invalid_argument unless `cell_m` is positive and every point finite and less than 1e15 cells away.
  PlanarGrid(const std::vector<Eigen::Vector2d>& points_m, double cell_m);

  /// Calls `test(index)` for points around `center_m`, among them every point that is at most one cell size away, until
  /// it returns true; tells whether it did. The order depends on the points alone.
  template <class Test>
  bool anyNear(const Eigen::Vector2d& center_m, Test test) const {
    const Cell center = cellOf(center_m);
    for (std::int64_t column = center.x - 1; column <= center.x + 1; ++column) {
      const Range range = rowsOfColumn(column, center.y - 1, center.y + 1);
      for (std::size_t i = range.begin; i < range.end; ++i) {
        if (test(entries_[i].index)) return true;
      }
    }
    return false;
  }

 private:
  struct Cell {
    std::int64_t x = 0;
    std::int64_t y = 0;
  };
  struct Entry {
    Cell cell;
    std::size_t index = 0;
  };
  struct Range {
    std::size_t begin = 0;
    std::size_t end = 0;
  };

  Cell cellOf(const Eigen::Vector2d& point_m) const;
  Range rowsOfColumn(std::int64_t column, std::int64_t first_row, std::int64_t last_row) const;

  double cell_m_;
  std::vector<Entry> entries_;  // by column, row, index
};

}  // namespace semantic_mht_slam
