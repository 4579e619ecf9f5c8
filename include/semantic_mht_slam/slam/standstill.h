#pragma once

#include <optional>

#include "semantic_mht_slam/common/pose.h"

namespace semantic_mht_slam {

class StateArchive;

/// Whether the vehicle has stood at one place so long that further frames from there say nothing new.
class Standstill {
 public:
  /// Takes the next frame; true if it need not be looked at.
  bool add(const Pose& T_odom_base);

  /// All that it knows (see `StateArchive`).
  void transfer(StateArchive& archive);

 private:
  std::optional<Pose> T_odom_stand_;  ///< where it stands, or was at its newest motion
  int frames_ = 0;
};

}  // namespace semantic_mht_slam
