#include "semantic_mht_slam/mapping/map_branching.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <tuple>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "semantic_mht_slam/common/log_math.h"

#include "earlier_map_placement.h"
#include "expected_landmarks.h"
#include "landmark_selection.h"

namespace semantic_mht_slam {
namespace {

constexpr double kGateMahalanobisSq = 11.3;
constexpr double kMaxGate = 1.0 / 15.0;  // of the radius
constexpr double kMaxWithheld = 3.0;     // nats of the evidence that the first look held back, at the end
constexpr double kFinal = 1.0 / 120.0;   // of the radius: prior of the last refinement, around the hypothesis's offset
constexpr double kFinal_rad = 0.02;

PoseOffset offsetOf(const RegistrationMode& mode) {
  const Eigen::Matrix3d R = mode.T_a_b.rotation.toRotationMatrix();
  PoseOffset offset;
  offset.mean << mode.T_a_b.translation_m, std::atan2(R(1, 0), R(0, 0));
  offset.cov = mode.headingCov();
  return offset;
}

}  // namespace

double logExpectationEvidence(int found, double missed) {
  const double unseen = std::max(0.0, missed);
  return std::lgamma(1.0 + found) + std::lgamma(1.0 + unseen) - std::lgamma(2.0 + found + unseen);
}

MapBranching::MapBranching(const MapAlignmentConfig& config, const ClassTable& classes,
                           const RegistrationConfig& registration)
    : config_(config), classes_(classes), registration_(registration) {}

void MapBranching::restart(EarlierMap map) {
  map_ = std::move(map);
  std::sort(map_.landmarks.begin(), map_.landmarks.end(),
            [](const MixtureLandmark& a, const MixtureLandmark& b) { return a.id < b.id; });
  next_attempt_m_ = config_.first_m;
}

std::vector<RegistrationMode> MapBranching::modesOf(const std::vector<const TrackedLandmark*>& landmarks,
                                                    const RegistrationPrior& prior,
                                                    std::vector<LandmarkId>& ids) const {
  ids.clear();
  if (static_cast<int>(landmarks.size()) < config_.min_landmarks) return {};
  std::vector<RegistrationPoint> points;
  Eigen::AlignedBox3d box;
  for (const TrackedLandmark* landmark : landmarks) {
    points.push_back({landmark->position.mean_m, landmark->position.cov_m2, landmark->mostLikelyClass()});
    ids.push_back(landmark->id);
    box.extend(prior.T_a_b * landmark->position.mean_m);
  }
  const double window_m = std::min<double>(registration_.max_window_m, registration_.window_sigmas * prior.stddev_xy_m);
  const double turn_m = registration_.window_sigmas * prior.stddev_yaw_rad * config_.radius_m;
  std::vector<RegistrationPoint> earlier;
  earlier_of_point_.clear();
  for (std::size_t i = 0; i < map_.landmarks.size(); ++i) {
    const MixtureLandmark& landmark = map_.landmarks[i];
    const Eigen::Vector3d& mean_m = landmark.position.mean_m;
    const Eigen::Vector3d gap_m = (mean_m - box.center()).cwiseAbs() - 0.5 * box.sizes();
    if (gap_m.head<2>().maxCoeff() > window_m + turn_m) continue;
    earlier.push_back({mean_m, landmark.position.cov_m2, landmark.mostLikelyClass()});
    earlier_of_point_.push_back(static_cast<int>(i));
  }
  return align(earlier, points, prior, classes_, registration_);
}

MapBranching::Matches MapBranching::matchesOf(const RegistrationMode& mode, const std::vector<LandmarkId>& ids) const {
  Matches matches;
  for (const RegisteredPair& pair : mode.pairs) {
    matches[ids[static_cast<std::size_t>(pair.b)]] = earlier_of_point_[static_cast<std::size_t>(pair.a)];
  }
  return matches;
}

bool MapBranching::branch(const TreeInput& input, double log_min_weight, std::uint64_t& next_hypothesis_id,
                          std::vector<MapHypothesis>& leaves) {
  if (!config_.enabled || map_.landmarks.empty() || input.driven_m < next_attempt_m_) return false;
  const bool is_decided = std::any_of(leaves.begin(), leaves.end(), [](const auto& leaf) { return leaf.map_offset; });
  if (is_decided) return false;
  next_attempt_m_ = input.driven_m + config_.retry_m;
  const RegistrationPrior prior{Pose::identity(), map_.stddev_xy_m, map_.stddev_z_m, map_.stddev_yaw_rad};
  std::vector<LandmarkId> ids;
  const auto modes = modesOf(
      nearestLandmarks(leaves.front(), input.T_submap_base.translation_m, config_.radius_m, config_.max_landmarks),
      prior, ids);
  if (modes.empty()) return false;
  const double gain = config_.log_prior_odds - std::max(0.0, modes.front().log_evidence - config_.max_log_evidence);
  std::vector<double> log_weights;
  for (const MapHypothesis& leaf : leaves) {
    log_weights.push_back(leaf.log_weight);
    for (const RegistrationMode& mode : modes) log_weights.push_back(leaf.log_weight + mode.log_evidence + gain);
  }
  const double log_least = logSumExp(log_weights) + log_min_weight;
  const std::size_t parents = leaves.size();
  for (const RegistrationMode& mode : modes) {
    const Matches matches = matchesOf(mode, ids);
    for (std::size_t p = 0; p < parents; ++p) {
      const double log_weight = leaves[p].log_weight + mode.log_evidence + gain;
      if (log_weight < log_least) continue;
      leaves.push_back(aligned(leaves[p], offsetOf(mode), matches, input));
      MapHypothesis& child = leaves.back();
      child.log_weight = log_weight;
      child.id = next_hypothesis_id++;
      child.parent_id = leaves[p].id;
      child.born_frame = input.frame;
    }
  }
  return true;
}

MapHypothesis MapBranching::aligned(const MapHypothesis& leaf, const PoseOffset& offset, Matches matches,
                                    const TreeInput& input) const {
  MapHypothesis child = leaf;
  child.map_offset = offset;
  const EarlierMapPlacement placement = placementBy(*child.map_offset);
  matchTheRest(leaf, placement, matches);
  std::vector<char> is_taken(map_.landmarks.size(), 0);
  for (HypothesisLandmark& landmark : child.landmarks) {
    const auto found = matches.find(landmark->id);
    if (found == matches.end()) continue;
    auto joined = std::make_shared<TrackedLandmark>(*landmark);
    joined->earlier = found->second;
    is_taken[static_cast<std::size_t>(found->second)] = 1;
    landmark.tracked = std::move(joined);
  }
  const double average = averageObservations(map_.landmarks);
  std::vector<HypothesisLandmark> landmarks;
  auto known = child.landmarks.begin();
  for (int i = 0; i < static_cast<int>(map_.landmarks.size()); ++i) {
    const MixtureLandmark& earlier = map_.landmarks[static_cast<std::size_t>(i)];
    if (is_taken[static_cast<std::size_t>(i)] != 0 || !isExpected(earlier, average)) continue;
    const double distance_m = (placement.mean_m(i) - input.T_submap_base.translation_m).head<2>().norm();
    if (distance_m >= config_.radius_m) continue;
    while (known != child.landmarks.end() && (*known)->id < earlier.id) landmarks.push_back(std::move(*known++));
    const bool is_known = known != child.landmarks.end() && (*known)->id == earlier.id;
    if (!is_known)
      landmarks.push_back(expectedLandmark(earlier, i, placement(i), input.driven_m, classes_, registration_));
  }
  std::move(known, child.landmarks.end(), std::back_inserter(landmarks));
  child.landmarks = std::move(landmarks);
  return child;
}

void MapBranching::matchTheRest(const MapHypothesis& leaf, const EarlierMapPlacement& placement,
                                Matches& matches) const {
  std::vector<char> is_taken(map_.landmarks.size(), 0);
  for (const auto& [id, earlier] : matches) is_taken[static_cast<std::size_t>(earlier)] = 1;
  struct Free {
    Eigen::Vector3d mean_m;
    int earlier;
    ClassIndex class_index;
  };
  std::vector<Free> free;  // by rising x
  for (int i = 0; i < static_cast<int>(map_.landmarks.size()); ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (is_taken[k] == 0) free.push_back({placement.mean_m(i), i, map_.landmarks[k].mostLikelyClass()});
  }
  std::sort(free.begin(), free.end(), [](const Free& a, const Free& b) { return a.mean_m.x() < b.mean_m.x(); });
  const double max_gate_m = kMaxGate * config_.radius_m;
  std::vector<std::tuple<double, LandmarkId, int>> pairs;
  for (const HypothesisLandmark& landmark : leaf.landmarks) {
    if (landmark->is_expected || matches.count(landmark->id) > 0) continue;
    const Eigen::Vector3d& mean_m = landmark->position.mean_m;
    const ClassIndex class_index = landmark->mostLikelyClass();
    auto near = std::lower_bound(free.begin(), free.end(), mean_m.x() - max_gate_m,
                                 [](const Free& known, double x_m) { return known.mean_m.x() < x_m; });
    for (; near != free.end() && near->mean_m.x() <= mean_m.x() + max_gate_m; ++near) {
      const Eigen::Vector3d d = near->mean_m - mean_m;
      if (near->class_index != class_index || d.head<2>().squaredNorm() > max_gate_m * max_gate_m) continue;
      const Eigen::Matrix3d cov_m2 = placement.cov_m2(near->earlier) + landmark->position.cov_m2;
      const auto fit = evaluate({Eigen::Vector3d::Zero(), cov_m2}, d);
      if (!fit || fit->mahalanobis_sq >= kGateMahalanobisSq) continue;
      pairs.emplace_back(fit->mahalanobis_sq, landmark->id, near->earlier);
    }
  }
  std::sort(pairs.begin(), pairs.end());
  for (const auto& [distance, id, earlier] : pairs) {
    if (matches.count(id) > 0 || is_taken[static_cast<std::size_t>(earlier)] != 0) continue;
    matches[id] = earlier;
    is_taken[static_cast<std::size_t>(earlier)] = 1;
  }
}

EarlierMapPlacement MapBranching::placementBy(const PoseOffset& offset) const {
  return {map_.landmarks, offset, registration_.noise_floor_m};
}

void MapBranching::follow(const std::vector<std::pair<int, const Measurement*>>& seen, MapHypothesis& leaf) const {
  if (seen.empty()) return;
  const Pose T_earlier_submap = poseOf(*leaf.map_offset);
  const Eigen::Matrix3d R = T_earlier_submap.rotation.toRotationMatrix();
  std::vector<OffsetObservation> observations;
  for (const auto& [index, measurement] : seen) {
    const Gaussian3& earlier = map_.landmarks[static_cast<std::size_t>(index)].position;
    OffsetObservation observation;
    observation.lever_m = R * measurement->position_m;
    observation.residual_m = earlier.mean_m - T_earlier_submap * measurement->position_m;
    observation.cov_m2 = earlier.cov_m2 + R * measurement->cov_m2 * R.transpose();
    observation.cov_m2.diagonal().array() += registration_.noise_floor_m * registration_.noise_floor_m;
    observations.push_back(observation);
  }
  leaf.map_offset = updated(*leaf.map_offset, observations, kOffsetHuberSigma);
  const EarlierMapPlacement placement = placementBy(*leaf.map_offset);
  for (HypothesisLandmark& landmark : leaf.landmarks) {
    if (!landmark->is_expected) continue;
    auto moved = std::make_shared<TrackedLandmark>(*landmark);
    moved->position = placement(landmark->earlier);
    landmark.tracked = std::move(moved);
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
        d.head<2>().norm() < 2.0 * registration_.distinct_m && std::abs(d[3]) < 2.0 * registration_.distinct_rad;
    (agrees ? weight : others) += std::exp(leaf.log_weight);
  }
  return weight / (weight + others);
}

std::optional<MapAlignment> MapBranching::conclude(const std::vector<MapHypothesis>& leaves) const {
  const auto best = std::find_if(leaves.begin(), leaves.end(), [](const auto& leaf) { return leaf.map_offset; });
  if (best == leaves.end()) return std::nullopt;
  MapAlignment alignment;
  alignment.T_earlier_submap = poseOf(*best->map_offset);
  alignment.cov = stepCov(*best->map_offset, registration_.tilt_stddev_rad);
  alignment.weight = agreeingWeight(leaves, *best->map_offset, 0.0);
  const RegistrationPrior prior{alignment.T_earlier_submap, kFinal * config_.radius_m, kFinal * config_.radius_m,
                                kFinal_rad};
  std::vector<LandmarkId> ids;
  const auto modes = modesOf(mostSeenLandmarks(*best, 2 * config_.max_landmarks), prior, ids);
  if (modes.empty()) return alignment;
  const PoseOffset offset = offsetOf(modes.front());
  Matches matches = matchesOf(modes.front(), ids);
  alignment.weight = agreeingWeight(leaves, *best->map_offset, modes.front().log_evidence);
  alignment.T_earlier_submap = modes.front().T_a_b;
  alignment.cov = modes.front().cov;
  alignment.matches = static_cast<int>(matches.size());
  alignment.is_accepted = alignment.weight >= config_.accept_prob && alignment.matches >= config_.min_matches;
  if (!alignment.is_accepted) return alignment;
  matchTheRest(*best, placementBy(offset), matches);
  for (const auto& [id, earlier] : matches) {
    const LandmarkId known = map_.landmarks[static_cast<std::size_t>(earlier)].id;
    if (id != known && findLandmark(id, map_.landmarks) == nullptr) alignment.pairs.push_back({id, known});
  }
  return alignment;
}

}  // namespace semantic_mht_slam
