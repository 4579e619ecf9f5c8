#include "semantic_mht_slam/mapping/landmark_propagation.h"

#include <algorithm>
#include <iterator>
#include <memory>
#include <utility>

#include "semantic_mht_slam/common/log_math.h"

namespace semantic_mht_slam {
namespace {

/// What a hypothesis believes of a landmark's visibility; that it is seen, if the hypothesis does not have it.
double visibilityOf(LandmarkId id, const MapHypothesis& hypothesis) {
  const HypothesisLandmark* landmark = findLandmark(id, hypothesis.landmarks);
  return landmark != nullptr ? landmark->existence.visible_prob : 1.0;
}

HypothesisLandmark goingOn(const MixtureLandmark& landmark, const MapHypothesis& best) {
  Existence existence;
  existence.log_odds = logit(std::clamp(landmark.existence_prob, 0.001, 0.999));
  existence.visible_prob = visibilityOf(landmark.id, best);
  return {std::make_shared<const TrackedLandmark>(trackedFrom(landmark)), existence};
}

bool isBefore(const HypothesisLandmark& a, const HypothesisLandmark& b) {
  return a->id < b->id;
}

}  // namespace

LandmarkPropagation::LandmarkPropagation(const MapperConfig& config)
    : reach_m_(config.detection.max_range_m + config.submap.length_m + config.association.max_gate_m),
      propagated_submaps_(static_cast<std::size_t>(config.submap.propagation_m / config.submap.length_m)) {}

void LandmarkPropagation::clear() {
  landmarks_.clear();
  resting_.clear();
}

bool LandmarkPropagation::carries(LandmarkId landmark) const {
  const auto isOfId = [landmark](const HypothesisLandmark& known) { return known->id == landmark; };
  return findLandmark(landmark, landmarks_) != nullptr || std::any_of(resting_.begin(), resting_.end(), isOfId);
}

void LandmarkPropagation::endSubmap(SubmapId submap, const Pose& T_odom_submap,
                                    const std::vector<MixtureLandmark>& landmarks, const MapHypothesis& best) {
  T_odom_last_ = T_odom_submap;
  last_offset_ = best.offset;
  const auto goesOn = [&](SubmapId last) { return last.index() + propagated_submaps_ >= submap.index(); };
  landmarks_.clear();
  for (const MixtureLandmark& landmark : landmarks) {
    if (goesOn(landmark.last_submap)) landmarks_.push_back(goingOn(landmark, best));
  }
  const auto of_submap = static_cast<std::ptrdiff_t>(landmarks_.size());
  for (HypothesisLandmark& landmark : resting_) {
    const auto end = landmarks_.begin() + of_submap;
    const bool is_known = std::binary_search(landmarks_.begin(), end, landmark, isBefore);
    if (!is_known && goesOn(landmark->last_submap)) landmarks_.push_back(std::move(landmark));
  }
  resting_.clear();
  std::inplace_merge(landmarks_.begin(), landmarks_.begin() + of_submap, landmarks_.end(), isBefore);
}

std::vector<HypothesisLandmark> LandmarkPropagation::beginSubmap(SubmapId submap, const Pose& T_odom_submap) {
  propagate(corrected(T_odom_last_.inverse() * T_odom_submap, last_offset_).inverse());
  std::vector<HypothesisLandmark> near;
  for (HypothesisLandmark& landmark : landmarks_) {
    (isOutOfReach(*landmark, submap) ? resting_ : near).push_back(std::move(landmark));
  }
  landmarks_.clear();
  return near;
}

void LandmarkPropagation::propagate(const Pose& T_new_old) {
  const Eigen::Matrix3d R = T_new_old.rotation.toRotationMatrix();
  for (HypothesisLandmark& landmark : landmarks_) {
    auto moved = std::make_shared<TrackedLandmark>(*landmark);
    moved->position.mean_m = T_new_old * landmark->position.mean_m;
    const Eigen::Matrix3d of_pose_m2 = pointCov(last_offset_, R.transpose() * moved->position.mean_m);
    moved->position.cov_m2 = R * (landmark->position.cov_m2 + of_pose_m2) * R.transpose();
    moved->is_from_earlier_submap = true;
    landmark.tracked = std::move(moved);
  }
}

/// What was seen in the submap before may be seen from farther away than detections are expected from.
bool LandmarkPropagation::isOutOfReach(const TrackedLandmark& landmark, SubmapId submap) const {
  return landmark.last_submap.index() + 1 < submap.index() && landmark.position.mean_m.head<2>().norm() > reach_m_;
}

}  // namespace semantic_mht_slam
