#include "semantic_mht_slam/mapping/hypothesis_tree.h"

#include <algorithm>
#include <cmath>

#include "semantic_mht_slam/mapping/hypothesis_merging.h"
#include "semantic_mht_slam/mapping/hypothesis_pruning.h"

namespace semantic_mht_slam {
namespace {

constexpr int kSettledObservations = 3;  // landmarks that may correct the pose
constexpr double kHuberSigma = 2.0;

void sortById(std::vector<TrackedLandmarkPtr>& landmarks) {
  std::sort(landmarks.begin(), landmarks.end(),
            [](const TrackedLandmarkPtr& a, const TrackedLandmarkPtr& b) { return a->id < b->id; });
}

}  // namespace

/// A child in the making.
struct MultiHypothesisTree::Growth {
  MapHypothesis child;
  std::shared_ptr<AssociationRecord> record;
  std::vector<char> is_seen;  ///< of each landmark of the parent
  std::vector<TrackedLandmarkPtr> born;
  int false_positives = 0;
  std::vector<std::pair<std::size_t, const Measurement*>> found;  ///< expected landmarks, and what was seen of them
};

MultiHypothesisTree::MultiHypothesisTree(const MapperConfig& config, const ClassTable& classes)
    : config_(config),
      model_(config, classes),
      tracking_(config, classes),
      branching_(config.alignment, classes),
      class_count_(classes.size()) {
  restart({});
}

void MultiHypothesisTree::restart(std::vector<TrackedLandmarkPtr> landmarks, EarlierMap earlier_map) {
  branching_.restart(std::move(earlier_map));
  MapHypothesis root;
  root.id = next_hypothesis_id_++;
  root.landmarks = std::move(landmarks);
  leaves_.clear();
  leaves_.push_back(std::move(root));
}

void MultiHypothesisTree::step(const TreeInput& input, Rng& rng) {
  std::vector<MapHypothesis> children;
  for (MapHypothesis& parent : leaves_) expand(parent, input, children);
  leaves_ = std::move(children);
  normalizeAndSort(leaves_);
  mergeEqualHypotheses(leaves_);
  normalizeAndSort(leaves_);
  if (branching_.branch(input, next_hypothesis_id_, leaves_)) normalizeAndSort(leaves_);
  pruneHypotheses(config_, leaves_, rng);
}

void MultiHypothesisTree::predict(MapHypothesis& hypothesis, const TreeInput& input) const {
  const SubmapConfig& submap = config_.submap;
  hypothesis.offset = grown(hypothesis.offset, input.step_m, submap.odometry_stddev_m, submap.odometry_stddev_rad);
}

void MultiHypothesisTree::measureFrom(const Pose& T_submap_base, const PoseOffset* offset, const TreeInput& input,
                                      std::vector<Measurement>& measurements) const {
  const Eigen::Matrix3d R = T_submap_base.rotation.toRotationMatrix();
  measurements = input.measurements;
  for (Measurement& measurement : measurements) {
    const Eigen::Vector3d lever_m = R * measurement.position_m;
    measurement.position_m = lever_m + T_submap_base.translation_m;
    measurement.cov_m2 = R * measurement.cov_m2 * R.transpose();
    measurement.R_submap_base = T_submap_base.rotation;
    if (offset == nullptr) continue;
    measurement.pose_cov_m2 = pointCov(*offset, lever_m);
    measurement.cov_m2 += measurement.pose_cov_m2;
  }
}

PoseOffset MultiHypothesisTree::offsetAfter(const MapHypothesis& parent, const TreeInput& input,
                                            const AssignmentList& assignments, int choice) const {
  const Pose T_submap_base = corrected(input.T_submap_base, parent.offset);
  std::vector<OffsetObservation> observations;
  for (int i = 0; i < problem_.measurements; ++i) {
    const int column = assignments.column(choice, i);
    if (!problem_.isLandmark(column)) continue;
    const TrackedLandmark& landmark = *parent.landmarks[static_cast<std::size_t>(column)];
    const Measurement measurement = ofObject(measurements_[static_cast<std::size_t>(i)], landmark.mostLikelyClass());
    if (landmark.is_expected || landmark.observations < kSettledObservations ||
        problem_.candidate(i, column)->is_outlier)
      continue;
    OffsetObservation observation;
    observation.lever_m = measurement.position_m - T_submap_base.translation_m;
    observation.residual_m = landmark.position.mean_m - measurement.position_m;
    observation.cov_m2 = landmark.position.cov_m2 + measurement.cov_m2 - pointCov(parent.offset, observation.lever_m);
    observation.cov_m2.diagonal().head<2>().array() +=
        measurement.wander_variance_per_m * (input.driven_m - landmark.updated_at_m);
    observations.push_back(observation);
  }
  return semantic_mht_slam::updated(parent.offset, observations, kHuberSigma);
}

void MultiHypothesisTree::expand(MapHypothesis& parent, const TreeInput& input, std::vector<MapHypothesis>& children) {
  predict(parent, input);
  measureFrom(corrected(input.T_submap_base, parent.offset), &parent.offset, input, measurements_);
  model_.formulate(parent, measurements_, input.driven_m, problem_);
  KBestOptions options;
  const bool is_single = config_.estimator == Estimator::kUkf || config_.tree.max_hypotheses == 1;
  options.max_assignments = is_single ? 1 : config_.tree.max_branches;
  options.max_cost_gap = config_.tree.branch_log_ratio;
  const AssignmentList& assignments = solver_.solve(problem_.costs, options);
  for (int choice = 0; choice < assignments.size(); ++choice) {
    children.push_back(makeChild(parent, input, assignments, choice));
  }
}

MapHypothesis MultiHypothesisTree::makeChild(const MapHypothesis& parent, const TreeInput& input,
                                             const AssignmentList& assignments, int choice) {
  Growth growth{parent, std::make_shared<AssociationRecord>(), std::vector<char>(parent.landmarks.size(), 0), {}, 0,
                {}};
  MapHypothesis& child = growth.child;
  const bool is_corrected = config_.submap.correct_pose;
  if (is_corrected) child.offset = offsetAfter(parent, input, assignments, choice);
  measureFrom(corrected(input.T_submap_base, child.offset), is_corrected ? nullptr : &child.offset, input, corrected_);
  if (assignments.size() > 1) {
    child.id = next_hypothesis_id_++;
    child.parent_id = parent.id;
    child.born_frame = input.frame;
  }
  growth.record->previous = parent.history;
  growth.record->frame = input.frame;
  growth.record->landmark_of_measurement.assign(input.measurements.size(), kNoLandmark);
  for (int i = 0; i < problem_.measurements; ++i) {
    const int column = assignments.column(choice, i);
    if (problem_.isLandmark(column)) growth.is_seen[static_cast<std::size_t>(column)] = 1;
  }
  for (int i = 0; i < problem_.measurements; ++i) assign(i, assignments.column(choice, i), parent, input, growth);
  child.false_positives += growth.false_positives;
  child.log_weight +=
      model_.logAssignmentPrior(static_cast<int>(growth.born.size()), growth.false_positives, problem_.measurements);
  child.log_weight += tracking_.applyMissedDetections(child, input, growth.is_seen);
  if (child.map_offset) {
    branching_.follow(parent, growth.found, child);
    child.log_weight += logExpectationEvidence(child) - logExpectationEvidence(parent);
  }
  child.landmarks.insert(child.landmarks.end(), growth.born.begin(), growth.born.end());
  if (!growth.found.empty()) sortById(child.landmarks);
  child.history = std::move(growth.record);
  return std::move(growth.child);
}

void MultiHypothesisTree::assign(int measurement, int column, const MapHypothesis& parent, const TreeInput& input,
                                 Growth& growth) const {
  const auto k = static_cast<std::size_t>(measurement);
  const Measurement& seen = corrected_[k];
  MapHypothesis& child = growth.child;
  LandmarkId& landmark = growth.record->landmark_of_measurement[k];
  child.log_weight += model_.logClassPrior(seen.class_index);
  if (problem_.isLandmark(column)) {
    const auto j = static_cast<std::size_t>(column);
    const Candidate& candidate = *problem_.candidate(measurement, column);
    child.landmarks[j] = tracking_.updated(model_, *parent.landmarks[j], seen, input, candidate);
    child.log_weight += candidate.log_likelihood;
    if (parent.landmarks[j]->is_expected) {
      growth.found.emplace_back(j, &seen);
      ++child.expected_found;
      child.expected_missed -= 1.0 - parent.landmarks[j]->miss_likelihood;
    }
    landmark = child.landmarks[j]->id;
    return;
  }
  child.log_weight += model_.logUniformDensity();
  const int whole = splitOf(parent, measurement, growth.is_seen);
  if (whole >= 0) {
    landmark = parent.landmarks[static_cast<std::size_t>(whole)]->id;
    ++growth.false_positives;
  } else if (problem_.isNew(column)) {
    growth.born.push_back(tracking_.begun(model_, seen, input));
    landmark = seen.id_if_new;
  } else {
    ++growth.false_positives;
  }
}

int MultiHypothesisTree::splitOf(const MapHypothesis& parent, int measurement, const std::vector<char>& is_seen) const {
  const double split_prob = config_.association.split_prob;
  int whole = -1;
  if (config_.estimator == Estimator::kUkf || split_prob == 0.0) return whole;
  double likeliest = model_.logClutterDensity() - std::log(split_prob);
  for (const Candidate& candidate : problem_.gated[static_cast<std::size_t>(measurement)]) {
    const auto j = static_cast<std::size_t>(candidate.landmark);
    if (is_seen[j] == 0 || parent.landmarks[j]->is_expected || candidate.log_part_likelihood <= likeliest) continue;
    likeliest = candidate.log_part_likelihood;
    whole = candidate.landmark;
  }
  return whole;
}

}  // namespace semantic_mht_slam
