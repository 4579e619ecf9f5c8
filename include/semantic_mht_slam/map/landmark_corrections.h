#pragma once

#include <utility>
#include <vector>

#include <Eigen/Core>

#include "semantic_mht_slam/map/landmark.h"

namespace semantic_mht_slam {

class StateArchive;

/// A landmark that a person took out of the map, and what is it again when it is seen anew.
struct RemovedLandmark {
  std::vector<LandmarkId> names;         ///< that it had, rising
  LandmarkId newest_name = kNoLandmark;  ///< of all landmarks then: later names may be this one again
  SubmapId submap;                       ///< whose frame the place is in
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  ClassIndex class_index = 0;
  double radius_m = 0.0;  ///< horizontal; what is seen later within it, of the same class, is this landmark

  void transfer(StateArchive& archive);
};

/// A landmark that a person declared right: in the frame of its `last_submap`.
struct LockedLandmark {
  std::vector<LandmarkId> names;  ///< that it had, rising
  MixtureLandmark landmark;

  void transfer(StateArchive& archive);
};

/// What a person said of landmarks. Outlives the program in the map file.
class LandmarkCorrections {
 public:
  void remove(RemovedLandmark removed) { removed_.push_back(std::move(removed)); }
  void lock(LockedLandmark locked) { locked_.push_back(std::move(locked)); }

  /// Forgets what removed, or locked, a landmark with one of these names; false if nothing did.
  bool bringBack(const std::vector<LandmarkId>& names);
  bool unlock(const std::vector<LandmarkId>& names);

  /// True if one of a landmark's names (rising) was removed, and none was another landmark's when that happened.
  bool isRemoved(const std::vector<LandmarkId>& names) const;

  /// The lock of a landmark; null without any.
  const LockedLandmark* lockOf(const std::vector<LandmarkId>& names) const;

  const std::vector<RemovedLandmark>& removed() const { return removed_; }
  const std::vector<LockedLandmark>& locked() const { return locked_; }

  void transfer(StateArchive& archive);

 private:
  std::vector<RemovedLandmark> removed_;
  std::vector<LockedLandmark> locked_;
};

}  // namespace semantic_mht_slam
