#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "semantic_mht_slam/models/class_table.h"

namespace semantic_mht_slam {

/// What one raw label id stands for.
struct LabelRule {
  int id = 0;
  ClassIndex class_index = 0;
  bool is_moving = false;  ///< the segmentation tells that the thing moves, for example SemanticKITTI's 252, moving car
};

/// Raw label ids of a segmentation to classes of a table. Every id is mapped, ignored or unknown. Immutable.
class LabelMap {
 public:
  static constexpr ClassIndex kIgnored = -1;
  static constexpr ClassIndex kUnknown = -2;
  static constexpr int kMaxId = 65535;

  /// Knows no id.
  LabelMap() : LabelMap({}, {}, "") {}

  /// Throws ConfigError naming every id that is outside [0, kMaxId] or stands twice. `origin` (a file name) begins each
  /// message.
  LabelMap(const std::vector<LabelRule>& rules, const std::vector<int>& ignored, const std::string& origin);

  /// The ids of the class table itself; every other id is ignored.
  static LabelMap ofTable(const ClassTable& classes);

  /// Class of a raw id, or kIgnored, or kUnknown.
  ClassIndex classOf(std::uint16_t id) const { return targets_[id].class_index; }

  bool isMoving(std::uint16_t id) const { return targets_[id].is_moving; }

 private:
  struct Target {
    ClassIndex class_index = kUnknown;
    bool is_moving = false;
  };

  std::vector<Target> targets_;  ///< by raw id
};

}  // namespace semantic_mht_slam
