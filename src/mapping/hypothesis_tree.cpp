#include "semantic_mht_slam/mapping/hypothesis_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "semantic_mht_slam/common/log_math.h"
#include "semantic_mht_slam/mapping/existence.h"
#include "semantic_mht_slam/mapping/hypothesis_merging.h"
#include "semantic_mht_slam/mapping/resampling.h"
#include "semantic_mht_slam/models/landmark_filter.h"

namespace semantic_mht_slam {
namespace {

constexpr double kLowDetectionProb = 0.01;    // below this nothing is expected
constexpr double kMaxLogExistenceOdds = 8.0;  // evidence beyond this would take too many misses to undo

constexpr int kSettledObservations = 3;  // landmarks that may correct the pose
constexpr double kHuberSigma = 2.0;

}  // namespace

MultiHypothesisTree::MultiHypothesisTree(const MapperConfig& config, const ClassTable& classes)
    : config_(config), model_(config, classes), class_count_(classes.size()) {
  restart({});
}

void MultiHypothesisTree::restart(std::vector<TrackedLandmarkPtr> landmarks) {
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
  normalizeAndSort();
  mergeEqualHypotheses(leaves_);
  normalizeAndSort();
  prune(rng);
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
    if (offset != nullptr) measurement.cov_m2 += pointCov(*offset, lever_m);
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
    const Measurement& measurement = measurements_[static_cast<std::size_t>(i)];
    if (landmark.observations < kSettledObservations || problem_.candidate(i, column)->is_outlier) continue;
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
  MapHypothesis child = parent;
  const bool is_corrected = config_.submap.correct_pose;
  if (is_corrected) child.offset = offsetAfter(parent, input, assignments, choice);
  measureFrom(corrected(input.T_submap_base, child.offset), is_corrected ? nullptr : &child.offset, input, corrected_);
  if (assignments.size() > 1) {
    child.id = next_hypothesis_id_++;
    child.parent_id = parent.id;
    child.born_frame = input.frame;
  }
  auto record = std::make_shared<AssociationRecord>();
  record->previous = parent.history;
  record->frame = input.frame;
  record->landmark_of_measurement.assign(input.measurements.size(), kNoLandmark);
  std::vector<char> is_seen(parent.landmarks.size(), 0);
  std::vector<TrackedLandmarkPtr> born;
  int false_positives = 0;
  for (int i = 0; i < problem_.measurements; ++i) {
    const int column = assignments.column(choice, i);
    if (problem_.isLandmark(column)) is_seen[static_cast<std::size_t>(column)] = 1;
  }
  for (int i = 0; i < problem_.measurements; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const Measurement& measurement = corrected_[k];
    const int column = assignments.column(choice, i);
    child.log_weight += model_.logClassPrior(measurement.class_index);
    if (problem_.isLandmark(column)) {
      const auto j = static_cast<std::size_t>(column);
      const Candidate& candidate = *problem_.candidate(i, column);
      child.landmarks[j] = updated(*parent.landmarks[j], measurement, input, candidate);
      child.log_weight += candidate.log_likelihood;
      record->landmark_of_measurement[k] = parent.landmarks[j]->id;
      continue;
    }
    child.log_weight -= model_.logMapVolume() + std::log(static_cast<double>(class_count_));
    const int whole = splitOf(problem_, i, is_seen);
    if (whole >= 0) {
      record->landmark_of_measurement[k] = parent.landmarks[static_cast<std::size_t>(whole)]->id;
      ++false_positives;
    } else if (problem_.isNew(column)) {
      born.push_back(makeLandmark(measurement, input));
      record->landmark_of_measurement[k] = measurement.id_if_new;
    } else {
      ++false_positives;
    }
  }
  child.false_positives += false_positives;
  child.log_weight += model_.logAssignmentPrior(static_cast<int>(born.size()), false_positives, problem_.measurements);
  child.log_weight += applyMissedDetections(child, input, is_seen);
  child.landmarks.insert(child.landmarks.end(), born.begin(), born.end());
  child.history = std::move(record);
  return child;
}

int MultiHypothesisTree::splitOf(const AssociationProblem& problem, int measurement,
                                 const std::vector<char>& is_seen) const {
  const double factor = config_.association.split_distance_factor;
  int whole = -1;
  double nearest = factor * factor * model_.gateMahalanobisSq();
  if (config_.estimator == Estimator::kUkf || nearest == 0.0) return -1;
  for (const Candidate& candidate : problem.gated[static_cast<std::size_t>(measurement)]) {
    if (is_seen[static_cast<std::size_t>(candidate.landmark)] == 0 || candidate.mahalanobis_sq >= nearest) continue;
    nearest = candidate.mahalanobis_sq;
    whole = candidate.landmark;
  }
  return whole;
}

TrackedLandmarkPtr MultiHypothesisTree::updated(const TrackedLandmark& landmark, const Measurement& measurement,
                                                const TreeInput& input, const Candidate& candidate) const {
  auto result = std::make_shared<TrackedLandmark>(landmark);
  Gaussian3 predicted = landmark.position;
  predicted.cov_m2.diagonal().head<2>().array() +=
      measurement.wander_variance_per_m * (input.driven_m - landmark.updated_at_m);
  result->updated_at_m = input.driven_m;
  PositionMeasurement position{measurement.position_m, measurement.cov_m2};
  if (candidate.is_outlier) position.cov_m2.diagonal() += measurement.outlier_variance_m2;
  const auto update = unscentedUpdate(predicted, position);
  if (update) result->position = update->posterior;
  result->class_probs = model_.updatedClassProbs(landmark.class_probs, measurement.class_index);
  ++result->observations;
  result->is_from_earlier_submap = false;
  result->last_submap = input.submap;
  // A detection where the landmark is speaks for it against clutter, which would be anywhere in the volume.
  const double log_clutter = std::log(config_.association.false_positive_density) - model_.logMapVolume() -
                             std::log(static_cast<double>(class_count_));
  applyHit(*result, detectionProb(landmark, input), config_.detection.visibility_switch_prob,
           candidate.log_likelihood - log_clutter, kMaxLogExistenceOdds);
  return result;
}

TrackedLandmarkPtr MultiHypothesisTree::makeLandmark(const Measurement& measurement, const TreeInput& input) const {
  auto landmark = std::make_shared<TrackedLandmark>();
  landmark->id = measurement.id_if_new;
  landmark->position = {measurement.position_m, measurement.cov_m2};
  landmark->class_probs = model_.initialClassProbs(measurement.class_index);
  landmark->log_existence_odds = logit(config_.detection.birth_prob);
  landmark->observations = 1;
  landmark->first_submap = input.submap;
  landmark->last_submap = input.submap;
  landmark->updated_at_m = input.driven_m;
  return landmark;
}

double MultiHypothesisTree::detectionProb(const TrackedLandmark& landmark, const TreeInput& input) const {
  const DetectionConfig& detection = config_.detection;
  const double range_m = (landmark.position.mean_m - input.T_submap_base.translation_m).head<2>().norm();
  if (range_m > detection.max_range_m) return kLowDetectionProb;
  const double ratio = range_m / detection.half_range_m;
  return std::max(kLowDetectionProb, detection.detection_prob / (1.0 + ratio * ratio * ratio * ratio));
}

double MultiHypothesisTree::applyMissedDetections(MapHypothesis& hypothesis, const TreeInput& input,
                                                  const std::vector<char>& is_seen) const {
  if (!config_.detection.missed_detections) return 0.0;
  const double switch_prob = config_.detection.visibility_switch_prob;
  const double forget_log_odds = logit(config_.detection.forget_prob);
  double log_weight = 0.0;
  std::size_t kept = 0;
  for (std::size_t j = 0; j < hypothesis.landmarks.size(); ++j) {
    TrackedLandmarkPtr landmark = std::move(hypothesis.landmarks[j]);
    const double detection_prob = detectionProb(*landmark, input);
    if (is_seen[j] != 0) {
      log_weight += std::log(detection_prob);
    } else if (detection_prob > kLowDetectionProb) {
      auto missed = std::make_shared<TrackedLandmark>(*landmark);
      const double likelihood = applyMiss(*missed, detection_prob, switch_prob);
      const double existence = logistic(landmark->log_existence_odds);
      log_weight += std::log1p(-existence * (1.0 - likelihood));
      landmark = std::move(missed);
      if (landmark->log_existence_odds < forget_log_odds) continue;
    }
    hypothesis.landmarks[kept++] = std::move(landmark);
  }
  hypothesis.landmarks.resize(kept);
  return log_weight;
}

void MultiHypothesisTree::normalizeAndSort() {
  std::vector<double> log_weights;
  for (const MapHypothesis& leaf : leaves_) log_weights.push_back(leaf.log_weight);
  const double log_sum = logSumExp(log_weights);
  for (MapHypothesis& leaf : leaves_) leaf.log_weight -= log_sum;
  std::stable_sort(leaves_.begin(), leaves_.end(),
                   [](const MapHypothesis& a, const MapHypothesis& b) { return a.log_weight > b.log_weight; });
}

void MultiHypothesisTree::prune(Rng& rng) {
  if (config_.estimator == Estimator::kMhm) {
    keepBestThird();
  } else {
    const double log_min = std::log(config_.tree.min_weight);
    while (leaves_.size() > 1 && leaves_.back().log_weight < log_min) leaves_.pop_back();
    normalizeAndSort();
    resample(rng);
  }
  normalizeAndSort();
}

void MultiHypothesisTree::keepBestThird() {
  const auto limit = static_cast<std::size_t>(config_.tree.max_hypotheses);
  if (leaves_.size() > limit) leaves_.resize(std::max<std::size_t>(1, limit / 3));
}

void MultiHypothesisTree::resample(Rng& rng) {
  const auto limit = static_cast<std::size_t>(config_.tree.max_hypotheses);
  std::vector<double> weights;
  for (const MapHypothesis& leaf : leaves_) weights.push_back(std::exp(leaf.log_weight));
  const bool is_degenerate =
      effectiveSampleSize(weights) < config_.tree.ess_ratio * static_cast<double>(leaves_.size());
  if (!is_degenerate && leaves_.size() <= limit) return;
  const std::vector<int> counts = kldResample(weights, config_.tree.kld_epsilon, config_.tree.kld_delta, limit, rng);
  std::vector<MapHypothesis> drawn;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (counts[i] == 0) continue;
    leaves_[i].log_weight = std::log(static_cast<double>(counts[i]));
    drawn.push_back(std::move(leaves_[i]));
  }
  leaves_ = std::move(drawn);
}

}  // namespace semantic_mht_slam
