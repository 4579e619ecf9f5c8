#include "semantic_mht_slam/mapping/frame_interpretation.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "semantic_mht_slam/common/log_math.h"
#include "semantic_mht_slam/mapping/map_branching.h"

namespace semantic_mht_slam {
namespace {

using Kind = MeasurementRole::Kind;

/// The landmark of the child that a measurement goes to.
LandmarkId idAfter(const MeasurementRole& role, const MapHypothesis& leaf, LandmarkId id_if_new) {
  if (role.kind == Kind::kNew) return id_if_new;
  if (role.landmark < 0) return kNoLandmark;
  const TrackedLandmark& landmark = *leaf.landmarks[static_cast<std::size_t>(role.landmark)];
  return landmark.is_expected ? id_if_new : landmark.id;
}

}  // namespace

FrameInterpreter::FrameInterpreter(const MapperConfig& config, const AssociationModel& model, const MapHypothesis& leaf,
                                   const LeafExpansion& expansion)
    : config_(config), model_(model), leaf_(leaf), expansion_(expansion), is_seen_(leaf.landmarks.size(), 0) {
  for (const LandmarkOutlook& outlook : expansion.outlooks) {
    log_all_missed_ += outlook.log_missed;
    all_expected_missed_ += outlook.expected_missed;
  }
  if (leaf.map_offset) log_expectation_ = logExpectationEvidence(leaf.expected_found, leaf.expected_missed);
}

FrameInterpretation FrameInterpreter::interpret(const AssignmentList& assignments, int choice) {
  const AssociationProblem& problem = expansion_.problem;
  const auto mark = [&](char is_seen) {
    for (int i = 0; i < problem.measurements; ++i) {
      const int column = assignments.column(choice, i);
      if (problem.isLandmark(column)) is_seen_[static_cast<std::size_t>(column)] = is_seen;
    }
  };
  mark(1);
  FrameInterpretation result;
  result.roles.reserve(problem.gated.size());
  result.landmark_of_measurement.reserve(problem.gated.size());
  for (int i = 0; i < problem.measurements; ++i) {
    result.roles.push_back(roleOf(i, assignments.column(choice, i)));
    const LandmarkId id_if_new = expansion_.measurements[static_cast<std::size_t>(i)].id_if_new;
    result.landmark_of_measurement.push_back(idAfter(result.roles.back(), leaf_, id_if_new));
  }
  mark(0);
  result.log_weight = leaf_.log_weight;
  weighDetections(result);
  weighLandmarks(result);
  return result;
}

MeasurementRole FrameInterpreter::roleOf(int measurement, int column) const {
  const AssociationProblem& problem = expansion_.problem;
  if (problem.isLandmark(column)) return {Kind::kLandmark, column, problem.candidate(measurement, column)};
  MeasurementRole role;
  role.kind = problem.isNew(column) ? Kind::kNew : Kind::kFalsePositive;
  if (config_.estimator == Estimator::kUkf || config_.association.split_prob == 0.0) return role;
  const Measurement& detected = expansion_.measurements[static_cast<std::size_t>(measurement)];
  double likeliest = 0.0;
  for (const Candidate& candidate : problem.gated[static_cast<std::size_t>(measurement)]) {
    const auto j = static_cast<std::size_t>(candidate.landmark);
    const bool may_be_part = is_seen_[j] != 0 && !leaf_.landmarks[j]->is_expected;
    if (!may_be_part) continue;
    const double log_odds = logOddsOfPart(detected, candidate, *leaf_.landmarks[j]);
    if (log_odds <= likeliest) continue;
    likeliest = log_odds;
    role = {Kind::kSecondPart, candidate.landmark, nullptr};
  }
  return role;
}

/// That it is a second part of a landmark, against clutter and against a neighbour that was not seen before.
double FrameInterpreter::logOddsOfPart(const Measurement& detected, const Candidate& candidate,
                                       const TrackedLandmark& landmark) const {
  const NeighbourDensity& neighbours = model_.neighbours();
  const Eigen::Vector3d offset_m = detected.position_m - landmark.position.mean_m;
  const double log_neighbour = neighbours.logDensity(detected.class_index, offset_m) +
                               neighbours.logFirstProb(detected.class_index, landmark.observations);
  return std::log(config_.association.split_prob) + candidate.log_part_likelihood -
         logAdd(model_.logClutterDensity(detected), log_neighbour);
}

void FrameInterpreter::weighDetections(FrameInterpretation& interpretation) const {
  for (std::size_t i = 0; i < interpretation.roles.size(); ++i) {
    const MeasurementRole& role = interpretation.roles[i];
    interpretation.log_weight += model_.logClassPrior(expansion_.measurements[i].class_index);
    interpretation.log_weight +=
        role.kind == Kind::kLandmark ? role.candidate->log_likelihood : model_.logUniformDensity();
    if (role.kind == Kind::kNew) ++interpretation.new_landmarks;
    if (role.kind == Kind::kSecondPart || role.kind == Kind::kFalsePositive) ++interpretation.false_positives;
  }
  interpretation.log_weight += model_.logAssignmentPrior(interpretation.new_landmarks, interpretation.false_positives,
                                                         expansion_.problem.measurements);
}

void FrameInterpreter::weighLandmarks(FrameInterpretation& interpretation) const {
  interpretation.log_weight += log_all_missed_;
  interpretation.expected_found = leaf_.expected_found;
  interpretation.expected_missed = leaf_.expected_missed + all_expected_missed_;
  for (const MeasurementRole& role : interpretation.roles) {
    if (role.kind != Kind::kLandmark) continue;
    const auto j = static_cast<std::size_t>(role.landmark);
    const LandmarkOutlook& outlook = expansion_.outlooks[j];
    interpretation.log_weight -= outlook.log_missed;
    if (config_.detection.missed_detections) interpretation.log_weight += std::log(outlook.detection_prob);
    if (!leaf_.landmarks[j]->is_expected) continue;
    ++interpretation.expected_found;
    interpretation.expected_missed -= outlook.expected_missed + 1.0 - leaf_.landmarks[j].existence.miss_likelihood;
  }
  if (!leaf_.map_offset) return;
  interpretation.log_weight +=
      logExpectationEvidence(interpretation.expected_found, interpretation.expected_missed) - log_expectation_;
}

void addInterpretation(FrameInterpretation interpretation, std::vector<FrameInterpretation>& interpretations) {
  for (FrameInterpretation& known : interpretations) {
    const bool is_same =
        known.leaf == interpretation.leaf && known.landmark_of_measurement == interpretation.landmark_of_measurement;
    if (!is_same) continue;
    const double log_weight = logAdd(known.log_weight, interpretation.log_weight);
    if (interpretation.log_weight > known.log_weight) known = std::move(interpretation);
    known.log_weight = log_weight;
    return;
  }
  interpretations.push_back(std::move(interpretation));
}

void dropUnlikely(double log_min_weight, std::vector<FrameInterpretation>& interpretations) {
  if (interpretations.empty()) throw std::logic_error("a frame without any interpretation");
  std::vector<double> log_weights;
  for (const FrameInterpretation& interpretation : interpretations) log_weights.push_back(interpretation.log_weight);
  const double log_sum = logSumExp(log_weights);
  const double log_least =
      std::min(log_sum + log_min_weight, *std::max_element(log_weights.begin(), log_weights.end()));
  const auto is_unlikely = [&](const FrameInterpretation& interpretation) {
    return interpretation.log_weight < log_least;
  };
  interpretations.erase(std::remove_if(interpretations.begin(), interpretations.end(), is_unlikely),
                        interpretations.end());
  for (FrameInterpretation& interpretation : interpretations) interpretation.log_weight -= log_sum;
}

}  // namespace semantic_mht_slam
