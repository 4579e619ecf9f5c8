#pragma once

#include <cstddef>
#include <vector>

#include "semantic_mht_slam/common/k_best_assignment.h"
#include "semantic_mht_slam/mapping/association.h"
#include "semantic_mht_slam/mapping/hypothesis.h"
#include "semantic_mht_slam/mapping/landmark_tracking.h"
#include "semantic_mht_slam/mapping/mapper_config.h"

namespace semantic_mht_slam {

/// What a leaf has to choose from when a frame comes. Its memory is used again.
struct LeafExpansion {
  std::vector<Measurement> measurements;  ///< submap frame, predicted pose, with the pose's uncertainty
  AssociationProblem problem;
  std::vector<LandmarkOutlook> outlooks;  ///< of each landmark of the leaf
};

/// What a measurement is taken for.
struct MeasurementRole {
  enum class Kind { kLandmark, kSecondPart, kNew, kFalsePositive };
  Kind kind = Kind::kFalsePositive;
  int landmark = -1;                     ///< of the leaf: it shows it (kLandmark), or a second part of it (kSecondPart)
  const Candidate* candidate = nullptr;  ///< of kLandmark; in the `LeafExpansion`, until its next frame
};

/// One way to read a frame: a child that a leaf may get, with the weight that it would have.
struct FrameInterpretation {
  std::size_t leaf = 0;
  std::vector<MeasurementRole> roles;               ///< of each measurement
  std::vector<LandmarkId> landmark_of_measurement;  ///< in the child; kNoLandmark: false positive
  int new_landmarks = 0;
  int false_positives = 0;
  int expected_found = 0;        ///< see `MapHypothesis`
  double expected_missed = 0.0;  ///< the same
  double log_weight = 0.0;
};

/// Reads frames as assignments have it, and weighs what that means (paper, equations 1 to 3), before anything is made.
class FrameInterpreter {
 public:
  /// All must outlive it.
  FrameInterpreter(const MapperConfig& config, const AssociationModel& model, const MapHypothesis& leaf,
                   const LeafExpansion& expansion);

  /// `choice` of the assignments of `expansion.problem`.
  FrameInterpretation interpret(const AssignmentList& assignments, int choice);

 private:
  MeasurementRole roleOf(int measurement, int column) const;
  double logOddsOfPart(const Measurement& detected, const Candidate& candidate, const TrackedLandmark& landmark) const;
  void weighDetections(FrameInterpretation& interpretation) const;
  void weighLandmarks(FrameInterpretation& interpretation) const;

  const MapperConfig& config_;
  const AssociationModel& model_;
  const MapHypothesis& leaf_;
  const LeafExpansion& expansion_;
  double log_all_missed_ = 0.0;       ///< log-likelihood of detecting no landmark
  double all_expected_missed_ = 0.0;  ///< what that adds to the number of expected ones that were missed
  double log_expectation_ = 0.0;      ///< evidence of what the leaf expected until now
  std::vector<char> is_seen_;         ///< each landmark of the leaf, in the present assignment
};

/// Adds an interpretation. Of two of a leaf that give the measurements to the same landmarks, the likelier one stays,
/// with the weight of both. They differ in which of two detections of an object is the second part, or in what the
/// earlier map has of a landmark (nothing, this one or that one), which the end of the submap decides from all of it.
void addInterpretation(FrameInterpretation interpretation, std::vector<FrameInterpretation>& interpretations);

/// Normalises the weights over all, then drops what is below exp(`log_min_weight`), but never the likeliest. Throws
/// std::logic_error for an empty list.
void dropUnlikely(double log_min_weight, std::vector<FrameInterpretation>& interpretations);

}  // namespace semantic_mht_slam
