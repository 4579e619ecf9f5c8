#include "semantic_mht_slam/mapping/map_branching.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "semantic_mht_slam/common/log_math.h"

#include "landmark_selection.h"

namespace semantic_mht_slam {
namespace {

constexpr double kGateMahalanobisSq = 11.3;
constexpr double kMaxGate_m = 4.0;
constexpr double kHuberSigma = 2.0;
constexpr double kHiddenOrNot = 0.5;                 // whether an expected landmark is in sight is not known
constexpr double kMinExistence = 0.5;                // of earlier landmarks that are expected
constexpr double kMaxWithheld = 3.0;                 // nats of the evidence that the first look held back, at the end
constexpr double kFinal_m = 0.5, kFinal_rad = 0.02;  // prior of the last refinement, around the hypothesis's offset

ClassIndex likeliestClass(const ClassProbs& probs) {
  Eigen::Index most_likely = 0;
  probs.maxCoeff(&most_likely);
  return static_cast<ClassIndex>(most_likely);
}

PoseOffset offsetOf(const AlignmentHypothesis& mode) {
  const Eigen::Matrix3d R = mode.T_a_b.rotation.toRotationMatrix();
  PoseOffset offset;
  offset.mean << mode.T_a_b.translation_m, std::atan2(R(1, 0), R(0, 0));
  offset.cov = mode.cov;
  return offset;
}

Pose poseOf(const PoseOffset& offset) {
  return corrected(Pose::identity(), offset);
}

double logMatchOdds(double existence_prob, bool is_static, const JointAlignmentConfig& config) {
  const double match_prob = is_static ? config.static_match_prob : config.movable_match_prob;
  return logit(std::clamp(existence_prob * match_prob, 0.001, 0.999));
}

}  // namespace

double logExpectationEvidence(const MapHypothesis& hypothesis) {
  const double found = hypothesis.expected_found;
  const double missed = std::max(0.0, hypothesis.expected_missed);
  return std::lgamma(1.0 + found) + std::lgamma(1.0 + missed) - std::lgamma(2.0 + found + missed);
}

MapBranching::MapBranching(const MapAlignmentConfig& config, const ClassTable& classes)
    : config_(config), classes_(classes) {}

void MapBranching::restart(EarlierMap map) {
  map_ = std::move(map);
  next_attempt_m_ = config_.first_m;
  index_of_.clear();
  for (std::size_t i = 0; i < map_.landmarks.size(); ++i) index_of_[map_.landmarks[i].id] = static_cast<int>(i);
}

std::vector<AlignmentHypothesis> MapBranching::align(const std::vector<const TrackedLandmark*>& landmarks,
                                                     const AlignmentPrior& prior, std::vector<LandmarkId>& ids) const {
  ids.clear();
  if (static_cast<int>(landmarks.size()) < config_.min_landmarks) return {};
  std::vector<AlignmentPoint> points;
  Eigen::AlignedBox3d box;
  for (const TrackedLandmark* landmark : landmarks) {
    points.push_back({landmark->position.mean_m, landmark->position.cov_m2, likeliestClass(landmark->class_probs)});
    ids.push_back(landmark->id);
    box.extend(prior.T_a_b * landmark->position.mean_m);
  }
  const double window_m = std::min(config_.joint.max_window_m, config_.joint.window_sigmas * prior.stddev_xy_m);
  const double turn_m = config_.joint.window_sigmas * prior.stddev_yaw_rad * config_.radius_m;
  std::vector<AlignmentPoint> earlier;
  earlier_of_point_.clear();
  for (std::size_t i = 0; i < map_.landmarks.size(); ++i) {
    const MixtureLandmark& landmark = map_.landmarks[i];
    const Eigen::Vector3d& mean_m = landmark.position.mean_m;
    const Eigen::Vector3d gap_m = (mean_m - box.center()).cwiseAbs() - 0.5 * box.sizes();
    if (gap_m.head<2>().maxCoeff() > window_m + turn_m) continue;
    earlier.push_back({mean_m, landmark.position.cov_m2, landmark.mostLikelyClass()});
    earlier_of_point_.push_back(static_cast<int>(i));
  }
  return alignJointly(points, earlier, prior, classes_, config_.joint);
}

MapBranching::Matches MapBranching::matchesOf(const AlignmentHypothesis& mode,
                                              const std::vector<LandmarkId>& ids) const {
  Matches matches;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const int point = mode.landmark_for_detection[i];
    if (point >= 0) matches[ids[i]] = earlier_of_point_[static_cast<std::size_t>(point)];
  }
  return matches;
}

bool MapBranching::branch(const TreeInput& input, std::uint64_t& next_hypothesis_id,
                          std::vector<MapHypothesis>& leaves) {
  if (!config_.enabled || map_.landmarks.empty() || input.driven_m < next_attempt_m_) return false;
  const bool is_decided = std::any_of(leaves.begin(), leaves.end(), [](const auto& leaf) { return leaf.map_offset; });
  if (is_decided) return false;
  next_attempt_m_ = input.driven_m + config_.retry_m;
  const AlignmentPrior prior{Pose::identity(), map_.stddev_xy_m, map_.stddev_z_m, map_.stddev_yaw_rad};
  std::vector<LandmarkId> ids;
  const auto modes = align(
      nearestLandmarks(leaves.front(), input.T_submap_base.translation_m, config_.radius_m, config_.max_landmarks),
      prior, ids);
  if (modes.empty()) return false;
  const double excess = std::max(0.0, modes.front().log_likelihood - config_.max_log_evidence);
  const std::size_t parents = leaves.size();
  for (const AlignmentHypothesis& mode : modes) {
    const Matches matches = matchesOf(mode, ids);
    for (std::size_t p = 0; p < parents; ++p) {
      leaves.push_back(aligned(leaves[p], mode, matches, input));
      MapHypothesis& child = leaves.back();
      child.log_weight += mode.log_likelihood - excess + config_.log_prior_odds;
      child.id = next_hypothesis_id++;
      child.parent_id = leaves[p].id;
      child.born_frame = input.frame;
    }
  }
  return true;
}

MapHypothesis MapBranching::aligned(const MapHypothesis& leaf, const AlignmentHypothesis& mode, const Matches& matches,
                                    const TreeInput& input) const {
  MapHypothesis child = leaf;
  child.map_offset = offsetOf(mode);
  Matches all = matches;
  matchTheRest(leaf, *child.map_offset, all);
  std::set<int> taken;
  for (TrackedLandmarkPtr& landmark : child.landmarks) {
    const auto found = all.find(landmark->id);
    if (found == all.end()) continue;
    auto joined = std::make_shared<TrackedLandmark>(*landmark);
    joined->earlier = found->second;
    taken.insert(found->second);
    landmark = std::move(joined);
  }
  const double reach_m = config_.radius_m;
  for (int i = 0; i < static_cast<int>(map_.landmarks.size()); ++i) {
    const MixtureLandmark& earlier = map_.landmarks[static_cast<std::size_t>(i)];
    if (taken.count(i) > 0 || earlier.existence_prob < kMinExistence) continue;
    TrackedLandmarkPtr landmark = expected(i, *child.map_offset, input);
    const double distance_m = (landmark->position.mean_m - input.T_submap_base.translation_m).head<2>().norm();
    const LandmarkPlace known = findLandmark(child.landmarks, earlier.id);
    if (distance_m < reach_m && !known.landmark) child.landmarks.insert(known.place, std::move(landmark));
  }
  return child;
}

void MapBranching::matchTheRest(const MapHypothesis& leaf, const PoseOffset& offset, Matches& matches) const {
  std::set<int> taken;
  for (const auto& [id, earlier] : matches) taken.insert(earlier);
  std::vector<std::pair<int, Gaussian3>> free;
  for (int i = 0; i < static_cast<int>(map_.landmarks.size()); ++i) {
    if (taken.count(i) == 0) free.emplace_back(i, placed(i, offset));
  }
  std::vector<std::tuple<double, LandmarkId, int>> pairs;
  for (const TrackedLandmarkPtr& landmark : leaf.landmarks) {
    if (landmark->is_expected || matches.count(landmark->id) > 0) continue;
    const ClassIndex class_index = likeliestClass(landmark->class_probs);
    for (const auto& [i, there] : free) {
      const Eigen::Vector3d d = there.mean_m - landmark->position.mean_m;
      if (d.head<2>().norm() > kMaxGate_m) continue;
      if (map_.landmarks[static_cast<std::size_t>(i)].mostLikelyClass() != class_index) continue;
      const auto fit = evaluate({Eigen::Vector3d::Zero(), there.cov_m2 + landmark->position.cov_m2}, d);
      if (fit && fit->mahalanobis_sq < kGateMahalanobisSq) pairs.emplace_back(fit->mahalanobis_sq, landmark->id, i);
    }
  }
  std::sort(pairs.begin(), pairs.end());
  for (const auto& [distance, id, earlier] : pairs) {
    if (matches.count(id) > 0 || taken.count(earlier) > 0) continue;
    matches[id] = earlier;
    taken.insert(earlier);
  }
}

Gaussian3 MapBranching::placed(int earlier, const PoseOffset& offset) const {
  const MixtureLandmark& landmark = map_.landmarks[static_cast<std::size_t>(earlier)];
  const Pose T_submap_earlier = poseOf(offset).inverse();
  const Eigen::Matrix3d R = T_submap_earlier.rotation.toRotationMatrix();
  const Eigen::Vector3d lever_m = landmark.position.mean_m - offset.mean.head<3>();
  Eigen::Matrix3d cov = landmark.position.cov_m2 + pointCov(offset, lever_m);
  cov.diagonal().array() += config_.joint.noise_floor_m * config_.joint.noise_floor_m;
  const Eigen::Matrix3d turned = R * cov * R.transpose();
  return {T_submap_earlier * landmark.position.mean_m, 0.5 * (turned + turned.transpose())};
}

TrackedLandmarkPtr MapBranching::expected(int earlier, const PoseOffset& offset, const TreeInput& input) const {
  const MixtureLandmark& landmark = map_.landmarks[static_cast<std::size_t>(earlier)];
  auto result = std::make_shared<TrackedLandmark>();
  result->id = landmark.id;
  result->position = placed(earlier, offset);
  result->class_probs = landmark.class_probs;
  result->log_existence_odds =
      logMatchOdds(landmark.existence_prob, classes_[landmark.mostLikelyClass()].is_static, config_.joint);
  result->visible_prob = kHiddenOrNot;
  result->observations = landmark.observations;
  result->is_from_earlier_submap = true;
  result->first_submap = landmark.first_submap;
  result->last_submap = landmark.last_submap;
  result->updated_at_m = input.driven_m;
  result->earlier = earlier;
  result->is_expected = true;
  return result;
}

void MapBranching::follow(const MapHypothesis& parent,
                          const std::vector<std::pair<std::size_t, const Measurement*>>& seen,
                          MapHypothesis& child) const {
  if (seen.empty()) return;
  const Pose T_earlier_submap = poseOf(*parent.map_offset);
  const Eigen::Matrix3d R = T_earlier_submap.rotation.toRotationMatrix();
  std::vector<OffsetObservation> observations;
  for (const auto& [place, measurement] : seen) {
    const Gaussian3& earlier = map_.landmarks[static_cast<std::size_t>(parent.landmarks[place]->earlier)].position;
    OffsetObservation observation;
    observation.lever_m = R * measurement->position_m;
    observation.residual_m = earlier.mean_m - T_earlier_submap * measurement->position_m;
    observation.cov_m2 = earlier.cov_m2 + R * measurement->cov_m2 * R.transpose();
    observation.cov_m2.diagonal().array() += config_.joint.noise_floor_m * config_.joint.noise_floor_m;
    observations.push_back(observation);
  }
  child.map_offset = updated(*parent.map_offset, observations, kHuberSigma);
  for (TrackedLandmarkPtr& landmark : child.landmarks) {
    if (!landmark->is_expected) continue;
    auto moved = std::make_shared<TrackedLandmark>(*landmark);
    moved->position = placed(landmark->earlier, *child.map_offset);
    landmark = std::move(moved);
  }
}

double MapBranching::agreeingWeight(const std::vector<MapHypothesis>& leaves, const PoseOffset& offset,
                                    double log_evidence) const {
  double weight = 0.0;
  double others = 0.0;
  const double withheld = std::clamp(log_evidence - config_.max_log_evidence, 0.0, kMaxWithheld);
  for (const MapHypothesis& leaf : leaves) {
    if (!leaf.map_offset) {
      others += std::exp(leaf.log_weight - withheld);
      continue;
    }
    const Eigen::Vector4d d = leaf.map_offset->mean - offset.mean;
    const bool agrees =
        d.head<2>().norm() < 2.0 * config_.joint.distinct_m && std::abs(d[3]) < 2.0 * config_.joint.distinct_rad;
    (agrees ? weight : others) += std::exp(leaf.log_weight);
  }
  return weight / (weight + others);
}

std::optional<MapConclusion> MapBranching::conclude(const std::vector<MapHypothesis>& leaves) const {
  const auto best = std::find_if(leaves.begin(), leaves.end(), [](const auto& leaf) { return leaf.map_offset; });
  if (best == leaves.end()) return std::nullopt;
  MapConclusion result;
  MapAlignment& alignment = result.alignment;
  alignment.T_earlier_submap = poseOf(*best->map_offset);
  alignment.cov = best->map_offset->cov;
  alignment.weight = agreeingWeight(leaves, *best->map_offset, 0.0);
  const AlignmentPrior prior{alignment.T_earlier_submap, kFinal_m, kFinal_m, kFinal_rad};
  std::vector<LandmarkId> ids;
  const auto modes = align(mostSeenLandmarks(*best, 2 * config_.max_landmarks), prior, ids);
  if (modes.empty()) return result;
  const PoseOffset offset = offsetOf(modes.front());
  Matches matches = matchesOf(modes.front(), ids);
  alignment.weight = agreeingWeight(leaves, *best->map_offset, modes.front().log_likelihood);
  alignment.T_earlier_submap = modes.front().T_a_b;
  alignment.cov = modes.front().cov;
  alignment.matches = static_cast<int>(matches.size());
  alignment.is_accepted = alignment.weight >= config_.accept_prob && alignment.matches >= config_.min_matches;
  if (!alignment.is_accepted) return result;
  matchTheRest(*best, offset, matches);
  for (const auto& [id, earlier] : matches) {
    const LandmarkId survivor = map_.landmarks[static_cast<std::size_t>(earlier)].id;
    if (id != survivor && index_of_.count(id) == 0) result.merged.push_back({id, survivor});
  }
  return result;
}

}  // namespace semantic_mht_slam
