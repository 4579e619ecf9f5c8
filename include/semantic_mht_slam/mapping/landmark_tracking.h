#pragma once

#include <optional>
#include <vector>

#include "semantic_mht_slam/mapping/association.h"
#include "semantic_mht_slam/mapping/detection_rate.h"
#include "semantic_mht_slam/mapping/hypothesis.h"
#include "semantic_mht_slam/mapping/mapper_config.h"
#include "semantic_mht_slam/models/landmark_filter.h"

namespace semantic_mht_slam {

/// What a frame says of a landmark of a hypothesis before its detections are assigned.
struct LandmarkOutlook {
  double detection_prob = 0.0;   ///< P_D if it is visible
  double log_missed = 0.0;       ///< log-likelihood of not being detected
  double expected_missed = 0.0;  ///< of an expected landmark: what not being detected adds to the hypothesis's number
  Existence missed;              ///< what it is if it is not detected
  bool is_forgotten = false;     ///< if it is not detected
};

/// What detections and their absence do to the landmarks of a hypothesis.
class LandmarkTracking {
 public:
  LandmarkTracking(const MapperConfig& config, const ClassTable& classes);

  /// What to expect of the landmarks of a hypothesis from where the base is. Those that should be seen lose existence
  /// if they are not, and below `forget_prob` they go.
  void lookOut(const MapHypothesis& hypothesis, const TreeInput& input, std::vector<LandmarkOutlook>& outlooks) const;

  /// The landmark after a detection (submap frame) that was assigned to it.
  HypothesisLandmark updated(const AssociationModel& model, const HypothesisLandmark& known,
                             const Measurement& detected, const TreeInput& input, const Candidate& candidate,
                             double detection_prob) const;

  /// A landmark that a detection (submap frame) begins.
  HypothesisLandmark begun(const AssociationModel& model, const Measurement& measurement, const TreeInput& input) const;

  /// What is known of P_D.
  DetectionRate& detectionRate() { return rate_; }

 private:
  void miss(const HypothesisLandmark& landmark, LandmarkOutlook& outlook) const;
  std::optional<FilterUpdate> filtered(const Gaussian3& predicted, const Measurement& measurement,
                                       bool is_outlier) const;

  MapperConfig config_;
  double log_forget_odds_;
  DetectionRate rate_;
};

}  // namespace semantic_mht_slam
