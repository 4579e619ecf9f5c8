#pragma once

#include <optional>

#include "semantic_mht_slam/common/stamped_pose.h"

namespace semantic_mht_slam {

class StateArchive;

/// Whether an odometry goes on from one sample to the next, or was set to zero, jumped or began anew. What a vehicle
/// can do is learned from what it did: a step goes on if it is no longer than a few times the greatest speed so far,
/// and what a vehicle can gain meanwhile, allow; a pose at the odometry's origin, far from the one before, is a new
/// beginning however long the pause was.
class OdometryContinuity {
 public:
  /// False if no motion leads from the newest sample to this one. Always true for the first.
  bool goesOn(const StampedPose& next) const;

  /// Takes the next sample; after one that did not go on, as the first of another odometry.
  void add(const StampedPose& next);

  /// The next sample is the first of another odometry.
  void clear() { *this = {}; }

  /// All that it knows (see `StateArchive`).
  void transfer(StateArchive& archive);

 private:
  std::optional<StampedPose> last_;
  int steps_ = 0;
  double speed_m_per_s_ = 0.0;  ///< greatest of late
  double turn_rate_rad_per_s_ = 0.0;
};

/// Whether a vehicle of which nothing is known may come from one sample to the next.
bool mayFollow(const StampedPose& sample, const StampedPose& next);

}  // namespace semantic_mht_slam
