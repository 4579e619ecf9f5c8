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

  /// Whether it stands there so long that a pose, too, says nothing new.
  bool holds(const Pose& T_odom_base) const { return frames_ >= kFrames && !hasMoved(T_odom_base); }

  /// All that it knows (see `StateArchive`).
  void transfer(StateArchive& archive);

 private:
  static constexpr int kFrames = 300;  // that are looked at

  bool hasMoved(const Pose& T_odom_base) const;

  std::optional<Pose> T_odom_stand_;  ///< where it stands, or was at its newest motion
  int frames_ = 0;
};

}  // namespace semantic_mht_slam
