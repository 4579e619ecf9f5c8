#include "semantic_mht_slam/mapping/hypothesis_tree.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "semantic_mht_slam/mapping/hypothesis_merging.h"
#include "semantic_mht_slam/mapping/hypothesis_pruning.h"

#include "landmark_selection.h"

namespace semantic_mht_slam {

Measurement inSubmap(Measurement measurement, const Pose& T_submap_base, const PoseOffset* offset) {
  const Eigen::Matrix3d R = T_submap_base.rotation.toRotationMatrix();
  const Eigen::Vector3d lever_m = R * measurement.position_m;
  measurement.position_m = lever_m + T_submap_base.translation_m;
  measurement.cov_m2 = R * measurement.cov_m2 * R.transpose();
  measurement.outlier_cov_m2 = R * measurement.outlier_cov_m2 * R.transpose();
  measurement.R_submap_base = T_submap_base.rotation;
  if (offset == nullptr) return measurement;
  measurement.pose_cov_m2 = pointCov(*offset, lever_m);
  measurement.cov_m2 += measurement.pose_cov_m2;
  return measurement;
}

MultiHypothesisTree::MultiHypothesisTree(const MapperConfig& config, const ClassTable& classes,
                                         const RegistrationConfig& registration)
    : config_(config),
      model_(config, classes),
      tracking_(config, classes),
      branching_(config.alignment, classes, registration) {
  restart({});
}

void MultiHypothesisTree::restart(std::vector<HypothesisLandmark> landmarks, EarlierMap earlier_map) {
  branching_.restart(std::move(earlier_map));
  MapHypothesis root;
  root.id = next_hypothesis_id_++;
  root.landmarks = std::move(landmarks);
  leaves_.clear();
  leaves_.push_back(std::move(root));
}

void MultiHypothesisTree::step(const TreeInput& input, Rng& rng) {
  std::vector<FrameInterpretation> interpretations;
  if (expansions_.size() < leaves_.size()) expansions_.resize(leaves_.size());
  for (std::size_t leaf = 0; leaf < leaves_.size(); ++leaf) expand(leaf, input, interpretations);
  const double log_min_weight = logMinWeight(config_);
  dropUnlikely(log_min_weight, interpretations);
  leaves_ = makeChildren(interpretations, input);
  normalizeAndSort(leaves_);
  mergeEqualHypotheses(leaves_);
  normalizeAndSort(leaves_);
  if (branching_.branch(input, log_min_weight, next_hypothesis_id_, leaves_)) normalizeAndSort(leaves_);
  pruneHypotheses(config_, leaves_, rng);
}

void MultiHypothesisTree::measureFrom(const Pose& T_submap_base, const PoseOffset* offset, const TreeInput& input,
                                      std::vector<Measurement>& measurements) const {
  measurements = input.measurements;
  for (Measurement& measurement : measurements) {
    measurement = inSubmap(std::move(measurement), T_submap_base, offset);
  }
}

PoseOffset MultiHypothesisTree::offsetAfter(const FrameInterpretation& interpretation, const TreeInput& input) const {
  const MapHypothesis& parent = leaves_[interpretation.leaf];
  const Pose T_submap_base = corrected(input.T_submap_base, parent.offset);
  std::vector<OffsetObservation> observations;
  Measurement of_class;
  for (std::size_t i = 0; i < interpretation.roles.size(); ++i) {
    const MeasurementRole& role = interpretation.roles[i];
    if (role.kind != MeasurementRole::Kind::kLandmark) continue;
    const TrackedLandmark& landmark = *parent.landmarks[static_cast<std::size_t>(role.landmark)];
    const bool is_settled = !landmark.is_expected && landmark.observations >= kSettledObservations;
    if (!is_settled || role.candidate->is_outlier) continue;
    const Measurement& measurement =
        ofObject(expansions_[interpretation.leaf].measurements[i], landmark.mostLikelyClass(), of_class);
    OffsetObservation observation;
    observation.lever_m = measurement.position_m - T_submap_base.translation_m;
    observation.residual_m = landmark.position.mean_m - measurement.position_m;
    observation.cov_m2 = landmark.position.cov_m2 + measurement.cov_m2 - pointCov(parent.offset, observation.lever_m);
    observation.cov_m2.diagonal().head<2>().array() +=
        measurement.wander_variance_per_m * (input.driven_m - landmark.updated_at_m);
    observations.push_back(observation);
  }
  return semantic_mht_slam::updated(parent.offset, observations, kOffsetHuberSigma);
}

void MultiHypothesisTree::expand(std::size_t leaf, const TreeInput& input,
                                 std::vector<FrameInterpretation>& interpretations) {
  MapHypothesis& parent = leaves_[leaf];
  LeafExpansion& expansion = expansions_[leaf];
  parent.offset = grown(parent.offset, input.T_submap_last, input.T_submap_base, input.odometry);
  measureFrom(corrected(input.T_submap_base, parent.offset), &parent.offset, input, expansion.measurements);
  model_.formulate(parent, expansion.measurements, input.driven_m, expansion.problem);
  tracking_.lookOut(parent, input, expansion.outlooks);
  KBestOptions options;
  const bool is_single = config_.estimator == Estimator::kUkf || config_.tree.max_hypotheses == 1;
  options.max_assignments = is_single ? 1 : config_.tree.max_branches;
  options.max_cost_gap = config_.tree.branch_log_ratio;
  const AssignmentList& assignments = solver_.solve(expansion.problem.costs, options);
  FrameInterpreter interpreter(config_, model_, parent, expansion);
  for (int choice = 0; choice < assignments.size(); ++choice) {
    FrameInterpretation interpretation = interpreter.interpret(assignments, choice);
    interpretation.leaf = leaf;
    addInterpretation(std::move(interpretation), interpretations);
  }
}

std::vector<MapHypothesis> MultiHypothesisTree::makeChildren(const std::vector<FrameInterpretation>& interpretations,
                                                             const TreeInput& input) {
  std::vector<int> children(leaves_.size(), 0);
  for (const FrameInterpretation& interpretation : interpretations) ++children[interpretation.leaf];
  std::vector<int> unmade = children;
  std::vector<MapHypothesis> result;
  for (const FrameInterpretation& interpretation : interpretations) {
    const std::size_t leaf = interpretation.leaf;
    result.push_back(makeChild(interpretation, input, --unmade[leaf] == 0));
    if (children[leaf] == 1) continue;
    result.back().id = next_hypothesis_id_++;
    result.back().parent_id = leaves_[leaf].id;
    result.back().born_frame = input.frame;
  }
  return result;
}

MapHypothesis MultiHypothesisTree::makeChild(const FrameInterpretation& interpretation, const TreeInput& input,
                                             bool is_last) {
  MapHypothesis& parent = leaves_[interpretation.leaf];
  MapHypothesis child = withoutLandmarks(parent);
  child.log_weight = interpretation.log_weight;
  child.false_positives += interpretation.false_positives;
  child.expected_found = interpretation.expected_found;
  child.expected_missed = interpretation.expected_missed;
  const bool is_corrected = config_.submap.correct_pose;
  if (is_corrected) child.offset = offsetAfter(interpretation, input);
  measureFrom(corrected(input.T_submap_base, child.offset), is_corrected ? nullptr : &child.offset, input, corrected_);
  if (is_last) {
    child.landmarks = std::move(parent.landmarks);
  } else {
    child.landmarks = parent.landmarks;
  }
  trackLandmarks(interpretation, input, child);
  auto record = std::make_shared<AssociationRecord>();
  record->previous = parent.history;
  record->frame = input.frame;
  record->landmark_of_measurement = interpretation.landmark_of_measurement;
  record->offset = child.offset;
  child.history = std::move(record);
  return child;
}

void MultiHypothesisTree::trackLandmarks(const FrameInterpretation& interpretation, const TreeInput& input,
                                         MapHypothesis& child) const {
  const LeafExpansion& expansion = expansions_[interpretation.leaf];
  std::vector<HypothesisLandmark>& landmarks = child.landmarks;
  std::vector<int> measurement_of(landmarks.size(), -1);
  for (std::size_t i = 0; i < interpretation.roles.size(); ++i) {
    const MeasurementRole& role = interpretation.roles[i];
    if (role.kind != MeasurementRole::Kind::kLandmark) continue;
    measurement_of[static_cast<std::size_t>(role.landmark)] = static_cast<int>(i);
  }
  std::vector<std::pair<int, const Measurement*>> found;
  std::vector<HypothesisLandmark> first_seen;  // whose ids are later than all others
  std::size_t kept = 0;
  for (std::size_t j = 0; j < landmarks.size(); ++j) {
    const LandmarkOutlook& outlook = expansion.outlooks[j];
    if (measurement_of[j] < 0) {
      if (outlook.is_forgotten) continue;
      landmarks[j].existence = outlook.missed;
    } else {
      const auto i = static_cast<std::size_t>(measurement_of[j]);
      const Candidate& candidate = *interpretation.roles[i].candidate;
      HypothesisLandmark seen =
          tracking_.updated(model_, landmarks[j], corrected_[i], input, candidate, outlook.detection_prob);
      if (landmarks[j]->is_expected) {
        found.emplace_back(landmarks[j]->earlier, &corrected_[i]);
        first_seen.push_back(std::move(seen));
        continue;
      }
      landmarks[j] = std::move(seen);
    }
    if (kept != j) landmarks[kept] = std::move(landmarks[j]);
    ++kept;
  }
  landmarks.resize(kept);
  for (std::size_t i = 0; i < interpretation.roles.size(); ++i) {
    if (interpretation.roles[i].kind != MeasurementRole::Kind::kNew) continue;
    first_seen.push_back(tracking_.begun(model_, corrected_[i], input));
  }
  std::sort(first_seen.begin(), first_seen.end(), [](const auto& a, const auto& b) { return a->id < b->id; });
  std::move(first_seen.begin(), first_seen.end(), std::back_inserter(landmarks));
  branching_.follow(found, child);
}

}  // namespace semantic_mht_slam
