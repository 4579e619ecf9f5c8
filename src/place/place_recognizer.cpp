#include "semantic_mht_slam/place/place_recognizer.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "semantic_mht_slam/place/scene_alignment.h"

namespace semantic_mht_slam {
namespace {

constexpr double kDriftShare = 0.02;      // of neighbouring keyframes relative to each other
constexpr double kNearShareOfGate = 0.5;  // further out two matches that agree are as likely two of a twin street
constexpr double kSamePlaceBase_m = 5.0;  // two matches of one keyframe that differ less name one place

bool passed(const PlaceMatch& match) {
  return match.refusal == PlaceRefusal::kNone;
}

/// What passed first, by falling score.
void sortMatches(std::vector<PlaceMatch>& matches) {
  std::stable_sort(matches.begin(), matches.end(), [](const PlaceMatch& a, const PlaceMatch& b) {
    return passed(a) != passed(b) ? passed(a) : a.verification_score > b.verification_score;
  });
}

PaperChainConfig paperConfig(const PlaceConfig& config) {
  PaperChainConfig paper = config.paper;
  paper.recent_m = config.recent_m;
  return paper;
}

}  // namespace

PlaceRecognizer::PlaceRecognizer(const PlaceConfig& config, const ClassTable& classes,
                                 const RegistrationConfig& registration)
    : config_(config), classes_(classes), registration_(registration) {
  config_.min_classes = std::min(config.min_classes, classes.size());
  if (config.chain == PlaceChain::kPaper) paper_.emplace(paperConfig(config), classes.size());
}

PlaceRecognizer::Place PlaceRecognizer::makePlace(Keyframe keyframe) const {
  Place place;
  place.descriptor = describePairs(keyframe.scene, classes_, registration_.noise_floor_m, config_.descriptor);
  place.keyframe = std::move(keyframe);
  return place;
}

void PlaceRecognizer::add(std::vector<Keyframe> keyframes, std::size_t poses) {
  if (poses != places_.size() + keyframes.size()) {
    throw std::invalid_argument("PlaceRecognizer: a pose of every keyframe is needed");
  }
  std::vector<Place> added;
  for (Keyframe& keyframe : keyframes) {
    const Keyframe* before = !added.empty()     ? &added.back().keyframe
                             : !places_.empty() ? &places_.back().keyframe
                                                : nullptr;
    if (before != nullptr && (keyframe.driven_m < before->driven_m || keyframe.submap < before->submap)) {
      throw std::invalid_argument("PlaceRecognizer: keyframes must come in the order of the drive");
    }
    added.push_back(makePlace(std::move(keyframe)));
  }
  for (Place& place : added) places_.push_back(std::move(place));
}

double PlaceRecognizer::drift(std::size_t query, std::size_t match) const {
  return config_.gate_per_driven_m * std::abs(places_[query].keyframe.driven_m - places_[match].keyframe.driven_m);
}

std::vector<std::size_t> PlaceRecognizer::gated(std::size_t query, std::size_t earlier,
                                                const std::vector<Pose>& T_map_keyframe) const {
  const Keyframe& asked = places_[query].keyframe;
  std::vector<std::pair<double, std::size_t>> near;
  for (std::size_t i = 0; i < earlier; ++i) {
    const Keyframe& keyframe = places_[i].keyframe;
    if (keyframe.submap >= asked.submap || asked.driven_m - keyframe.driven_m < config_.recent_m) break;
    const double distance_m = (T_map_keyframe[query].translation_m - T_map_keyframe[i].translation_m).head<2>().norm();
    if (config_.drift_gate && distance_m > config_.gate_base_m + drift(query, i)) continue;
    near.emplace_back(distance_m, i);
  }
  const std::size_t max_compared = config_.max_compared;
  if (config_.drift_gate && near.size() > max_compared) {
    std::nth_element(near.begin(), near.begin() + config_.max_compared, near.end());
    near.resize(max_compared);
  }
  std::vector<std::size_t> result;
  for (const auto& place : near) result.push_back(place.second);
  std::sort(result.begin(), result.end());
  return result;
}

PlaceRecognizer::Ranking PlaceRecognizer::mostAlike(const Place& query, const std::vector<std::size_t>& places) const {
  Ranking ranked;
  for (const std::size_t i : places) {
    ranked.emplace_back(-descriptorSimilarity(query.descriptor, places_[i].descriptor), i);
  }
  const std::size_t count = std::min<std::size_t>(ranked.size(), config_.max_candidates);
  std::partial_sort(ranked.begin(), ranked.begin() + count, ranked.end());
  ranked.resize(count);
  return ranked;
}

std::vector<PlaceMatch> PlaceRecognizer::compare(const Place& query, std::size_t query_index,
                                                 const std::vector<std::size_t>& places) const {
  std::vector<PlaceMatch> matches;
  for (const auto& [negative_score, i] : mostAlike(query, places)) {
    PlaceMatch match;
    match.refusal = PlaceRefusal::kUnlikePlace;
    if (-negative_score >= config_.min_descriptor_score) match = verify(query, i);
    match.query = query_index;
    match.match = i;
    match.descriptor_score = -negative_score;
    matches.push_back(std::move(match));
  }
  sortMatches(matches);
  return matches;
}

std::vector<PlaceMatch> PlaceRecognizer::comparePaper(const Keyframe& query, std::size_t query_index,
                                                      const ClassHistogram& submap_histogram) {
  const std::size_t max_candidates = config_.max_candidates;
  std::vector<PlaceMatch> matches;
  for (const PaperCandidate& candidate : paper_->query(query, submap_histogram)) {
    if (candidate.submap >= query.submap) continue;
    if (matches.size() == max_candidates) break;
    PlaceMatch match;
    if (candidate.refusal == PlaceRefusal::kNone) match = verify(places_[query_index], candidate.place);
    if (candidate.refusal != PlaceRefusal::kNone) match.refusal = candidate.refusal;
    match.query = query_index;
    match.match = candidate.place;
    match.histogram_divergence = candidate.histogram_divergence;
    match.topology_score = candidate.topology_score;
    match.scene_score = candidate.scene_score;
    match.loop_prob = candidate.loop_prob;
    matches.push_back(std::move(match));
  }
  sortMatches(matches);
  return matches;
}

PlaceMatch PlaceRecognizer::verify(const Place& query, std::size_t index) const {
  const Scene& of_query = query.keyframe.scene;
  const Scene& of_match = places_[index].keyframe.scene;
  PlaceMatch match;
  const std::vector<SceneAlignment> alignments = alignScenes(of_query, of_match, classes_, registration_, config_);
  if (alignments.empty()) {
    match.refusal = PlaceRefusal::kNoAlignment;
    return match;
  }
  const SceneAlignment& best = alignments.front();
  match.T_match_query = best.mode.T_a_b;
  match.cov = best.mode.cov;
  match.inliers = static_cast<int>(best.mode.pairs.size());
  match.static_inliers = best.static_inliers;
  match.verification_score = best.similarity;
  match.scene_score = best.soft_inliers > 0.0 ? std::min(1.0, best.similarity / best.soft_inliers) : 0.0;
  match.log_evidence = best.mode.log_evidence;
  match.rival_score = rivalSimilarity(alignments, config_);
  for (const RegisteredPair& pair : best.mode.pairs) {
    match.pairs.emplace_back(of_query.objects[pair.b].landmark, of_match.objects[pair.a].landmark);
  }
  match.refusal = checkAlignment(best, match.rival_score, config_);
  return match;
}

void PlaceRecognizer::refuseOutsideGate(std::vector<PlaceMatch>& matches,
                                        const std::vector<Pose>& T_map_keyframe) const {
  for (PlaceMatch& match : matches) {
    if (passed(match) && gateShare(match, T_map_keyframe) > 1.0) match.refusal = PlaceRefusal::kOutsideGate;
  }
}

double PlaceRecognizer::gateShare(const PlaceMatch& match, const std::vector<Pose>& T_map_keyframe) const {
  if (!config_.drift_gate) return 0.0;
  const Pose T_map_query = T_map_keyframe[match.match] * match.T_match_query;
  const double distance_m = (T_map_query.translation_m - T_map_keyframe[match.query].translation_m).head<2>().norm();
  return distance_m / (config_.gate_base_m + drift(match.query, match.match));
}

bool PlaceRecognizer::isEnough(const PlaceMatch& match, const std::vector<Pose>& T_map_keyframe) const {
  const double share = gateShare(match, T_map_keyframe);
  if (match.verification_score >= config_.lone_score * (1.0 + config_.far_factor * share * share)) return true;
  return share < kNearShareOfGate && isSupported(match, recent_, T_map_keyframe);
}

void PlaceRecognizer::refuseRivals(std::vector<PlaceMatch>& matches, const std::vector<Pose>& T_map_keyframe) const {
  if (matches.empty() || !passed(matches.front())) return;
  const PlaceMatch& best = matches.front();
  const Pose T_map_best = T_map_keyframe[best.match] * best.T_match_query;
  const auto isRival = [&](const PlaceMatch& other) {
    if (!passed(other) || other.verification_score < config_.rival_ratio * best.verification_score) return false;
    const Pose T_map_other = T_map_keyframe[other.match] * other.T_match_query;
    return (T_map_best.translation_m - T_map_other.translation_m).head<2>().norm() >
           kSamePlaceBase_m + drift(best.match, other.match);
  };
  const bool has_rival = std::any_of(matches.begin() + 1, matches.end(), isRival);
  for (PlaceMatch& match : matches) {
    if (passed(match)) match.refusal = has_rival ? PlaceRefusal::kRivalPlace : PlaceRefusal::kBetterCandidate;
  }
  if (!has_rival) matches.front().refusal = PlaceRefusal::kNone;
}

bool PlaceRecognizer::agree(const PlaceMatch& a, const PlaceMatch& b, const std::vector<Pose>& T_map_keyframe) const {
  const auto wayBetween = [this](std::size_t i, std::size_t k) {
    return std::abs(places_[i].keyframe.driven_m - places_[k].keyframe.driven_m);
  };
  const double query_way_m = wayBetween(a.query, b.query);
  const double match_way_m = wayBetween(a.match, b.match);
  if (std::max(query_way_m, match_way_m) > config_.support_reach_m) return false;
  const Pose T_qa_qb = T_map_keyframe[a.query].inverse() * T_map_keyframe[b.query];
  const Pose T_ma_mb = T_map_keyframe[a.match].inverse() * T_map_keyframe[b.match];
  const Pose by_a = a.T_match_query * T_qa_qb;
  const Pose by_b = T_ma_mb * b.T_match_query;
  return (by_a.translation_m - by_b.translation_m).head<2>().norm() <
             config_.agree_m + kDriftShare * (query_way_m + match_way_m) &&
         angularDistance(by_a.rotation, by_b.rotation) < config_.agree_rad;
}

bool PlaceRecognizer::isSupported(const PlaceMatch& match, const std::vector<PlaceMatch>& others,
                                  const std::vector<Pose>& T_map_keyframe) const {
  return std::any_of(others.begin(), others.end(), [&](const PlaceMatch& other) {
    return other.query != match.query && agree(match, other, T_map_keyframe);
  });
}

std::vector<PlaceMatch> PlaceRecognizer::process(std::vector<Keyframe> keyframes,
                                                 const std::vector<Pose>& T_map_keyframe, const SubmapSummary& submap) {
  const std::size_t earlier = places_.size();
  const std::vector<Keyframe> asked = paper_ ? keyframes : std::vector<Keyframe>{};
  add(std::move(keyframes), T_map_keyframe.size());
  if (paper_) paper_->add(submap.histogram, asked);
  if (!submap.is_checked) {
    if (paper_) paper_->resetFilter();
    return {};
  }
  std::vector<std::vector<PlaceMatch>> of_queries;
  for (std::size_t query = earlier; query < places_.size(); ++query) {
    of_queries.push_back(paper_ ? comparePaper(asked[query - earlier], query, submap.histogram)
                                : compare(places_[query], query, gated(query, earlier, T_map_keyframe)));
  }
  return decide(std::move(of_queries), T_map_keyframe);
}

std::vector<PlaceMatch> PlaceRecognizer::decide(std::vector<std::vector<PlaceMatch>> of_queries,
                                                const std::vector<Pose>& T_map_keyframe) {
  for (std::vector<PlaceMatch>& matches : of_queries) {
    refuseOutsideGate(matches, T_map_keyframe);
    std::stable_partition(matches.begin(), matches.end(), passed);
    refuseRivals(matches, T_map_keyframe);
    if (!matches.empty() && passed(matches.front())) recent_.push_back(matches.front());
  }
  std::vector<PlaceMatch> result;
  for (std::vector<PlaceMatch>& matches : of_queries) {
    if (!matches.empty() && passed(matches.front())) {
      PlaceMatch& best = matches.front();
      best.accepted = isEnough(best, T_map_keyframe);
      if (!best.accepted) best.refusal = PlaceRefusal::kUnsupported;
    }
    std::move(matches.begin(), matches.end(), std::back_inserter(result));
  }
  forgetOldMatches();
  return result;
}

void PlaceRecognizer::forgetOldMatches() {
  if (places_.empty()) return;
  const double oldest_m = places_.back().keyframe.driven_m - config_.support_reach_m;
  const auto is_old = [&](const PlaceMatch& match) { return places_[match.query].keyframe.driven_m < oldest_m; };
  recent_.erase(std::remove_if(recent_.begin(), recent_.end(), is_old), recent_.end());
}

std::vector<std::size_t> PlaceRecognizer::mostAlike(const Scene& scene) const {
  Keyframe keyframe;
  keyframe.scene = scene;
  std::vector<std::size_t> all(places_.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  std::vector<std::size_t> result;
  for (const auto& [negative_score, i] : mostAlike(makePlace(std::move(keyframe)), all)) {
    if (-negative_score >= config_.min_descriptor_score) result.push_back(i);
  }
  return result;
}

}  // namespace semantic_mht_slam
