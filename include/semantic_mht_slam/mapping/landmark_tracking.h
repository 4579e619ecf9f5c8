#pragma once

#include <optional>
#include <vector>

#include "semantic_mht_slam/mapping/association.h"
#include "semantic_mht_slam/mapping/detection_rate.h"
#include "semantic_mht_slam/mapping/hypothesis.h"
#include "semantic_mht_slam/mapping/mapper_config.h"
#include "semantic_mht_slam/models/landmark_filter.h"

namespace semantic_mht_slam {

/// What detections and their absence do to the landmarks of a hypothesis.
class LandmarkTracking {
 public:
  LandmarkTracking(const MapperConfig& config, const ClassTable& classes);

  /// The landmark after a detection (submap frame) that was assigned to it.
  TrackedLandmarkPtr updated(const AssociationModel& model, const TrackedLandmark& landmark,
                             const Measurement& detected, const TreeInput& input, const Candidate& candidate) const;

  /// A landmark that a detection (submap frame) begins.
  TrackedLandmarkPtr begun(const AssociationModel& model, const Measurement& measurement, const TreeInput& input) const;

  /// Existence of landmarks that should have been seen and were not; those that fall below `forget_prob` go.
  /// `is_seen` has an entry a landmark. Returns the log weight of all detections and misses.
  double applyMissedDetections(MapHypothesis& hypothesis, const TreeInput& input,
                               const std::vector<char>& is_seen) const;

  /// P_D of a visible landmark from where the base is.
  double detectionProb(const TrackedLandmark& landmark, const TreeInput& input) const;

  /// What is known of P_D.
  DetectionRate& detectionRate() { return rate_; }

 private:
  std::optional<FilterUpdate> filtered(const Gaussian3& predicted, const Measurement& measurement,
                                       bool is_outlier) const;

  MapperConfig config_;
  DetectionRate rate_;
};

}  // namespace semantic_mht_slam
