#include "semantic_mht_slam/slam/loop_closer.h"

#include <algorithm>
#include <utility>

#include "semantic_mht_slam/common/state_archive.h"
#include "semantic_mht_slam/common/state_checks.h"
#include "semantic_mht_slam/slam/drift_prior.h"

namespace semantic_mht_slam {
namespace {

LoopClosureRecord toRecord(PlaceMatch match, const std::vector<KeyframeId>& keyframe_of_place) {
  LoopClosureRecord record;
  record.source = ClosureSource::kPlace;
  record.query_keyframe = keyframe_of_place[match.query];
  record.match_keyframe = keyframe_of_place[match.match];
  record.is_verified = match.accepted;
  record.reason = reasonText(match.refusal);
  record.score = match.verification_score;
  record.place = {match.histogram_divergence, match.descriptor_score, match.topology_score, match.scene_score,
                  match.loop_prob};
  record.inliers = match.inliers;
  record.T_match_query = match.T_match_query;
  record.cov = match.cov;
  record.pairs = std::move(match.pairs);
  return record;
}

}  // namespace

void transfer(StateArchive& archive, SubmapPrediction& prediction) {
  auto& [prior, T_map_keyframe] = prediction;
  auto& [T_a_b, stddev_xy_m, stddev_z_m, stddev_yaw_rad] = prior;
  archive(T_a_b, stddev_xy_m, stddev_z_m, stddev_yaw_rad, T_map_keyframe);
  archive.require(stddev_xy_m >= 0.0 && stddev_z_m >= 0.0 && stddev_yaw_rad >= 0.0, "a negative deviation");
}

LoopCloser::LoopCloser(const BackEndConfig& config, const ClassTable& classes, const RegistrationConfig& registration,
                       double range_factor)
    : config_(config),
      classes_(classes),
      registration_(registration),
      units_(range_factor),
      evaluator_(makeSubmapEvaluator(config.evaluator, config.evaluator.tree, classes.size())),
      places_(config.place, classes, units_.toPlaces(registration)) {}

std::vector<ClosureSource> LoopCloser::sources() const {
  if (!config_.close_loops) return {};
  std::vector<ClosureSource> sources = {ClosureSource::kHypotheses};
  if (config_.recognise_places) sources.push_back(ClosureSource::kPlace);
  if (config_.revisit.enabled) sources.push_back(ClosureSource::kRevisit);
  return sources;
}

void LoopCloser::add(const Map& map) {
  checks_.push_back({false, evaluator_.add(*map.submaps().back())});
}

void LoopCloser::takeIn(const Map& map, SubmapId id) {
  const Submap& submap = *map.submaps()[id];
  checks_.push_back({false, evaluator_.add(submap)});
  std::vector<Keyframe> keyframes;
  for (const KeyframeId keyframe : map.keyframesOf(id)) {
    if (!isSearched(keyframe)) continue;
    keyframes.push_back(units_.toPlaces(map.keyframes()[keyframe]));
    keyframe_of_place_.push_back(keyframe);
  }
  places_.process(std::move(keyframes), placePoses(map), {classHistogram(submap.landmarks, classes_.size()), false});
}

std::vector<LoopClosureRecord> LoopCloser::find(ClosureSource source, const Map& map, const ClosureQuery& query) {
  if (source == ClosureSource::kHypotheses) return closeByHypotheses(map, query);
  return source == ClosureSource::kPlace ? recognisePlaces(map, query) : revisits(map, query);
}

bool LoopCloser::isSearched(KeyframeId keyframe) const {
  return keyframe.index() % config_.closure_stride == 0;
}

std::vector<Pose> LoopCloser::placePoses(const Map& map) const {
  std::vector<Pose> poses;
  for (const KeyframeId keyframe : keyframe_of_place_) poses.push_back(units_.toPlaces(map.T_map_keyframe(keyframe)));
  return poses;
}

std::vector<LoopClosureRecord> LoopCloser::recognisePlaces(const Map& map, const ClosureQuery& query) {
  std::vector<Keyframe> keyframes;
  for (const KeyframeId id : query.keyframes) {
    if (!isSearched(id)) continue;
    keyframes.push_back(units_.toPlaces(map.keyframes()[id]));
    keyframe_of_place_.push_back(id);
  }
  SubmapCheck& check = checks_.back();
  check.is_checked = check.evaluation.worth_checking;
  const SubmapSummary summary{classHistogram(map.submaps().back()->landmarks, classes_.size()), check.is_checked};
  std::vector<LoopClosureRecord> records;
  for (PlaceMatch& match : places_.process(std::move(keyframes), placePoses(map), summary)) {
    records.push_back(toRecord(units_.fromPlaces(std::move(match)), keyframe_of_place_));
  }
  return records;
}

SubmapPrediction LoopCloser::predict(const Map& map, const Pose& T_map_submap, double tied_at_m,
                                     const Motion& ahead) const {
  return {driftPrior(map, tied_at_m, T_map_submap, ahead, odometry_, config_.revisit), map.T_map_keyframes()};
}

std::vector<LoopClosureRecord> LoopCloser::closeByHypotheses(const Map& map, const ClosureQuery& query) const {
  if (!query.alignment) return {};
  const MapAlignment& alignment = *query.alignment;
  const IdVector<KeyframeId, Pose>& T_map_keyframe = query.prediction.T_map_keyframe;
  const Pose T_map_submap = query.prediction.prior.T_a_b * alignment.T_earlier_submap;
  const KeyframeId first = query.keyframes.front();
  KeyframeId nearest;
  const auto distance = [&](KeyframeId k) {
    return (T_map_keyframe[k].translation_m - T_map_submap.translation_m).norm();
  };
  for (const KeyframeId k : T_map_keyframe.ids()) {
    if (map.keyframes()[first].driven_m - map.keyframes()[k].driven_m < config_.revisit.min_driven_m) break;
    if (nearest.isNone() || distance(k) < distance(nearest)) nearest = k;
  }
  if (nearest.isNone()) return {};
  LoopClosureRecord record;
  record.source = ClosureSource::kHypotheses;
  record.query_keyframe = first;
  record.match_keyframe = nearest;
  record.is_verified = alignment.is_accepted;
  if (!alignment.is_accepted) record.reason = "the hypotheses do not agree";
  record.score = alignment.weight;
  record.inliers = alignment.matches;
  record.T_match_query = T_map_keyframe[nearest].inverse() * T_map_submap;
  record.cov = alignment.cov;
  record.pairs = alignment.pairs;
  return {std::move(record)};
}

std::vector<LoopClosureRecord> LoopCloser::revisits(const Map& map, const ClosureQuery& query) const {
  const double tied_at_m = std::max(query.tied_at_m, map.closedAt_m());
  std::vector<LoopClosureRecord> found;
  for (const KeyframeId keyframe : query.keyframes) {
    if (!isSearched(keyframe)) continue;
    const RegistrationPrior prior =
        driftPrior(map, tied_at_m, map.T_map_keyframe(keyframe), {}, odometry_, config_.revisit);
    for (auto& record : findRevisits(map, keyframe, prior, classes_, registration_, config_.revisit)) {
      found.push_back(std::move(record));
    }
  }
  return found;
}

std::vector<LoopCloser::Placing> LoopCloser::placingsOf(const Scene& scene, const Map& map) const {
  const Scene asked = units_.toPlaces(scene);
  const std::vector<RegistrationPoint> seen = registrationPoints(asked);
  const RegistrationConfig registration = units_.toPlaces(registration_);
  std::vector<Placing> placings;
  for (const std::size_t place : places_.mostAlike(asked)) {
    const KeyframeId keyframe = keyframe_of_place_[place];
    const Scene around = units_.toPlaces(sceneAround(map, keyframe, config_.revisit));
    for (const RegistrationMode& mode : align(registrationPoints(around), seen, std::nullopt, classes_, registration)) {
      PlaceMatch match;
      match.T_match_query = mode.T_a_b;
      match.cov = mode.cov;
      match = units_.fromPlaces(std::move(match));
      placings.push_back({{keyframe, match.T_match_query, match.cov},
                          map.T_map_keyframe(keyframe) * match.T_match_query,
                          mode.log_evidence});
    }
  }
  std::stable_sort(placings.begin(), placings.end(),
                   [](const Placing& a, const Placing& b) { return a.log_evidence > b.log_evidence; });
  return placings;
}

std::optional<FoundPlace> LoopCloser::locate(const Map& map, const Scene& scene) const {
  const std::vector<Placing> placings = placingsOf(scene, map);
  if (placings.empty() || placings.front().log_evidence < config_.revisit.min_log_evidence) return std::nullopt;
  const Placing& best = placings.front();
  const double agree_m = units_.fromPlaces(config_.place.agree_m);
  const auto isElsewhere = [&](const Placing& other) {
    return (best.T_map_base.translation_m - other.T_map_base.translation_m).head<2>().norm() > agree_m ||
           angularDistance(best.T_map_base.rotation, other.T_map_base.rotation) > config_.place.agree_rad;
  };
  const auto rival = std::find_if(placings.begin(), placings.end(), isElsewhere);
  const bool is_ambiguous =
      rival != placings.end() && best.log_evidence - rival->log_evidence < config_.revisit.min_log_margin;
  if (is_ambiguous) return std::nullopt;
  return best.place;
}

std::optional<FoundPlace> LoopCloser::findNear(const Map& map, const Scene& scene, const Pose& T_map_base,
                                               double stddev_m, const Motion& motion) const {
  const RegistrationPrior prior = driftPrior(T_map_base, stddev_m, motion, odometry_, config_.revisit);
  const LoopClosureRecord* best = nullptr;
  const std::vector<LoopClosureRecord> records = findInMap(map, scene, prior, classes_, registration_, config_.revisit);
  for (const LoopClosureRecord& record : records) {
    if (record.is_verified && (best == nullptr || record.score > best->score)) best = &record;
  }
  if (best == nullptr) return std::nullopt;
  return FoundPlace{best->match_keyframe, best->T_match_query, best->cov};
}

void transfer(StateArchive& archive, SubmapFeatures& features) {
  auto& [entropy, tf_idf, landmarks] = features;
  archive(entropy, tf_idf, landmarks);
}

void transfer(StateArchive& archive, SubmapCheck& check) {
  auto& [is_checked, evaluation] = check;
  auto& [features, good_prob, worth_checking] = evaluation;
  archive(is_checked, features, good_prob, worth_checking);
}

void LoopCloser::transfer(StateArchive& archive, const Map& map) {
  archive(keyframe_of_place_, checks_);
  if (checks_.size() != map.submaps().size()) StateArchive::fail("a submap that was not evaluated");
  for (const KeyframeId keyframe : keyframe_of_place_) {
    if (!map.keyframes().has(keyframe)) StateArchive::fail("a place that is no keyframe");
  }
  archive.require(areRising(keyframe_of_place_, [](KeyframeId id) { return id; }), "places that are not in order");
  IdVector<SubmapId, PlacesOfSubmap> places;
  if (archive.isReading()) {
    for (const auto& submap : map.submaps()) {
      evaluator_.add(*submap);  // counts the rarity of classes again
      places.push_back({classHistogram(submap->landmarks, classes_.size()), {}});
    }
    for (const KeyframeId id : keyframe_of_place_) {
      const Keyframe& keyframe = map.keyframes()[id];
      places[keyframe.submap].keyframes.push_back(units_.toPlaces(keyframe));
    }
  }
  places_.transfer(archive, {places.begin(), places.end()});
}

}  // namespace semantic_mht_slam
