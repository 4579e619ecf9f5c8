#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "semantic_mht_slam/common/stamp.h"
#include "semantic_mht_slam/map/ids.h"
#include "semantic_mht_slam/map/landmark.h"

namespace semantic_mht_slam {

/// Something that a detection may be of, and what speaks for it. The three logarithms add up to those of its odds
/// against clutter, before other detections claim the same landmark.
struct AssociationAlternative {
  LandmarkId landmark = kNoLandmark;  ///< kNoLandmark: nothing
  double probability = 0.0;           ///< those of all alternatives of a detection add up to 1
  double distance_sigma = 0.0;        ///< Mahalanobis distance, of detection and landmark together; nothing: 0
  double log_expected = 0.0;          ///< odds that the frame shows the landmark: it exists, and would be detected
  double log_place = 0.0;             ///< density of the centroid there over that of clutter
  double log_class = 0.0;             ///< probability of the detected class, by what the landmark is
  int observations = 0;               ///< detections that the landmark has
  double log_count_prior = 0.0;  ///< log g(N), by which the tree preferred it, frame by frame; not in `probability`
};

/// A detection whose landmark is not sure when its submap ends.
struct UnsureDetection {
  std::size_t frame = 0;
  Stamp stamp = 0;
  int row = 0;  ///< in its frame
  ClassIndex class_index = 0;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  ///< submap frame
  LandmarkId landmark = kNoLandmark;                     ///< that it was given to
  double probability = 0.0;                              ///< of that (see `DetectionAssociation`)
  double moving_prob = 0.0;                              ///< that what it shows moves, and is no landmark
  double log_clutter_density = 0.0;                      ///< of its class there, 1/m^3 a frame
  std::vector<AssociationAlternative> alternatives;      ///< if it does not move; by falling probability
};

/// Those of a finished submap.
struct UnsureDetections {
  SubmapId submap;
  std::size_t detections = 0;          ///< of the submap
  std::size_t unsure = 0;              ///< of these
  double below_prob = 0.0;             ///< whose probability is below this
  std::vector<UnsureDetection> items;  ///< the least sure of them, by frame and row
};

/// Which detections are explained.
struct ExplainLimits {
  double below_prob = 0.0;  ///< those whose probability is below this; 0: none
  std::size_t most = 0;     ///< so many of a submap at most, the least sure ones
};

/// Picks them while a submap is gone through; what is not picked is not explained.
class UnsureSelection {
 public:
  explicit UnsureSelection(const ExplainLimits& limits) : limits_(limits) {}

  /// The next detection, by rising frame and row; `explain` returns an UnsureDetection with that probability.
  template <class Explain>
  void note(double probability, const Explain& explain) {
    ++result_.detections;
    if (!(probability < limits_.below_prob)) return;
    ++result_.unsure;
    if (isPicked(probability)) add(explain());
  }

  UnsureDetections take(SubmapId submap);

 private:
  bool isPicked(double probability) const;
  void add(UnsureDetection detection);

  ExplainLimits limits_;
  UnsureDetections result_;  ///< its items are a heap, the surest on top
};

}  // namespace semantic_mht_slam
