#include "semantic_mht_slam/merging/overlap.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <set>
#include <utility>

#include "overlap_candidates.h"

namespace semantic_mht_slam {
namespace {

constexpr double kHopeless = -10.0;    // log odds at which no further tile is asked
constexpr double kCertain = 60.0;      // and where there is no doubt left
constexpr double kFewestTiles = 15;    // that are asked before
constexpr double kUnbounded = 30.0;    // most that a tile says when two hypotheses are compared
constexpr double kCoveredShare = 0.5;  // of a tile's landmarks that the other vehicle came near
constexpr double kMaxMissingUndriven = 0.5;
constexpr double kAnchorEvidence = 3.0;  // from which on a tile says where its neighbours are

/// Asks one hypothesis tile by tile.
class HypothesisTest {
 public:
  HypothesisTest(const MergeMap& a, const MergeMap& b, const MergeSettings& settings, const MergeConfig& config)
      : a_(a), b_(b), settings_(settings), config_(config) {}

  OverlapHypothesis run(const OverlapCandidate& seed) {
    begin(seed);
    int asked = 0;
    while (asked < config_.max_tiles) {
      const std::optional<std::size_t> tile = nearestTile();
      if (!tile) break;
      is_open_[*tile] = false;
      if (ask(b_.tiles()[*tile], result_.anchors[anchor_of_[*tile]])) ++asked;
      if (result_.log_odds < kHopeless - prior_ || (result_.log_odds > kCertain && asked >= kFewestTiles)) break;
    }
    return std::move(result_);
  }

 private:
  void begin(const OverlapCandidate& seed) {
    const double places = static_cast<double>(std::max<std::size_t>(1, a_.tiles().size())) *
                          static_cast<double>(std::max<std::size_t>(1, b_.tiles().size()));
    prior_ = std::log(places);
    used_.insert(seed.landmarks.begin(), seed.landmarks.end());
    const double bound = config_.max_log_odds * static_cast<double>(seed.pairs);
    result_.log_odds = std::min(seed.log_evidence, bound) - prior_;
    result_.log_evidence = std::min(seed.log_evidence, kUnbounded) - prior_;
    result_.landmarks = seed.pairs;
    is_open_.assign(b_.tiles().size(), true);
    way_m_.assign(b_.tiles().size(), 0.0);
    anchor_of_.assign(b_.tiles().size(), 0);
    addAnchor({seed.a, seed.b, seed.T_a_b, seed.log_evidence});
  }

  void addAnchor(const OverlapAnchor& anchor) {
    result_.anchors.push_back(anchor);
    for (std::size_t t = 0; t < is_open_.size(); ++t) {
      const double way_m = b_.driven_m(b_.tiles()[t].keyframe, anchor.b);
      if (result_.anchors.size() > 1 && way_m >= way_m_[t]) continue;
      way_m_[t] = way_m;
      anchor_of_[t] = result_.anchors.size() - 1;
    }
  }

  std::optional<std::size_t> nearestTile() const {
    std::optional<std::size_t> nearest;
    for (std::size_t t = 0; t < is_open_.size(); ++t) {
      if (is_open_[t] && (!nearest || way_m_[t] < way_m_[*nearest])) nearest = t;
    }
    return nearest;
  }

  /// True if the other map has seen the place, so that the tile bore witness.
  bool ask(const MapTile& tile, OverlapAnchor anchor) {
    std::vector<RegistrationPoint> points;
    for (std::size_t i = 0; i < tile.points.size(); ++i) {
      if (used_.count(tile.landmarks[i]) == 0) points.push_back(tile.points[i]);
    }
    if (static_cast<int>(points.size()) < config_.min_tile_landmarks) return false;
    const RegistrationPrior prior = priorOf(tile, anchor);
    if (!isCovered(points, prior.T_a_b)) return false;
    const std::vector<RegistrationPoint> near = pointsNear(points, prior);
    const auto modes = align(near, points, prior, settings_.classes, settings_.slam.registration);
    double odds = 0.0;
    for (const RegistrationMode& mode : modes) odds += std::exp(std::min(mode.log_evidence, 50.0));
    const double matches = modes.empty() ? 0.0 : static_cast<double>(modes.front().pairs.size());
    const double log_odds = std::log(1.0 - config_.found_prob + config_.found_prob * odds);
    result_.log_odds += std::min(log_odds, config_.max_log_odds * matches);
    result_.log_evidence += std::min(log_odds, kUnbounded);
    if (log_odds <= 0.0) ++result_.tiles_missing;
    if (log_odds <= 0.0) return true;
    ++result_.tiles_found;
    result_.landmarks += static_cast<int>(matches);
    if (log_odds < kAnchorEvidence) return true;
    const Pose T_a_keyframe = modes.front().T_a_b * tile.T_keyframe_tile.inverse();
    const KeyframeId nearest = a_.nearestKeyframe(T_a_keyframe.translation_m);
    const Pose T_a_b = a_.map().T_map_keyframe(nearest).inverse() * T_a_keyframe;
    addAnchor({nearest, tile.keyframe, T_a_b, modes.front().log_evidence});
    return true;
  }

  /// Of the middle of a tile, so wide that its few landmarks can tell place and heading better.
  RegistrationPrior priorOf(const MapTile& tile, const OverlapAnchor& anchor) const {
    RegistrationPrior prior = priorAt(tile.keyframe, anchor, a_, b_, settings_);
    prior.T_a_b = prior.T_a_b * tile.T_keyframe_tile;
    const double lever_m = prior.stddev_yaw_rad * tile.T_keyframe_tile.translation_m.head<2>().norm();
    prior.stddev_xy_m =
        std::max(std::hypot(prior.stddev_xy_m, lever_m), config_.tile_stddev_m * settings_.range_factor);
    prior.stddev_z_m = prior.stddev_xy_m;
    prior.stddev_yaw_rad = std::max(prior.stddev_yaw_rad, config_.tile_stddev_rad);
    return prior;
  }

  std::vector<RegistrationPoint> pointsNear(const std::vector<RegistrationPoint>& points,
                                            const RegistrationPrior& prior) const {
    double reach_m = settings_.slam.registration.density_radius_m + 3.0 * prior.stddev_xy_m;
    double farthest_m = 0.0;
    for (const RegistrationPoint& point : points) farthest_m = std::max(farthest_m, point.position_m.head<2>().norm());
    reach_m += farthest_m * (1.0 + std::min(1.0, 3.0 * prior.stddev_yaw_rad));
    std::vector<RegistrationPoint> result;
    for (const RegistrationPoint& point : a_.points()) {
      if ((point.position_m - prior.T_a_b.translation_m).head<2>().norm() < reach_m) result.push_back(point);
    }
    return result;
  }

  /// Whether the other vehicle came so near to most of the points that it must have seen them.
  bool isCovered(const std::vector<RegistrationPoint>& points, const Pose& T_a_b) const {
    const double radius_m = config_.seen_within_m * settings_.range_factor;
    const auto& T_a_keyframe = a_.map().T_map_keyframes();
    const auto is_passed = [&](const RegistrationPoint& point) {
      const Eigen::Vector3d at_m = T_a_b * point.position_m;
      return std::any_of(T_a_keyframe.begin(), T_a_keyframe.end(),
                         [&](const Pose& pose) { return (pose.translation_m - at_m).head<2>().norm() < radius_m; });
    };
    const auto covered = std::count_if(points.begin(), points.end(), is_passed);
    return static_cast<double>(covered) > kCoveredShare * static_cast<double>(points.size());
  }

  const MergeMap& a_;
  const MergeMap& b_;
  const MergeSettings& settings_;
  const MergeConfig& config_;
  double prior_ = 0.0;
  std::set<LandmarkId> used_;
  OverlapHypothesis result_;
  std::vector<bool> is_open_;
  std::vector<double> way_m_;
  std::vector<std::size_t> anchor_of_;
};

/// Whether a hypothesis says mostly the same as another one that was found before, where both are known best.
bool isSame(const OverlapHypothesis& known, const OverlapHypothesis& other, const MergeMap& a, const MergeMap& b,
            const MergeSettings& settings, const MergeConfig& config) {
  std::size_t agreeing = 0;
  for (const OverlapAnchor& asked : other.anchors) {
    const auto nearest = std::min_element(
        known.anchors.begin(), known.anchors.end(),
        [&](const auto& x, const auto& y) { return b.driven_m(x.b, asked.b) < b.driven_m(y.b, asked.b); });
    if (agree(*nearest, asked, a, b, settings, config)) ++agreeing;
  }
  return 2 * agreeing > other.anchors.size();
}

void weigh(OverlapPosterior& posterior, const MergeConfig& config) {
  const OverlapHypothesis& best = posterior.hypotheses.front();
  double none = std::exp(-std::min(best.log_odds, 500.0));
  double rivals = 0.0;
  for (std::size_t h = 1; h < posterior.hypotheses.size(); ++h) {
    const double less = best.log_evidence - posterior.hypotheses[h].log_evidence;
    rivals += std::exp(-less / config.rival_temper);
  }
  const double sum = 1.0 + none + rivals;
  posterior.prob = 1.0 / sum;
  posterior.none_prob = none / sum;
}

std::string percent(double prob) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.1f %%", 100.0 * prob);
  return text;
}

/// Whether so large a part of a map has counterparts that it is the same place, whatever else is missing.
bool isWhole(const OverlapHypothesis& hypothesis, const MergeMap& a, const MergeMap& b, const MergeConfig& config) {
  const double smaller = static_cast<double>(std::min(a.points().size(), b.points().size()));
  return hypothesis.landmarks >= config.whole_share * smaller;
}

/// Whether it is known where a vehicle went; of bare landmarks it is not, nor what it must have seen.
bool isDriven(const MergeMap& map) {
  return !map.parts().sessions.summary(map.map()).empty();
}

std::string reasonOf(const OverlapPosterior& posterior, const MergeMap& a, const MergeMap& b,
                     const MergeConfig& config) {
  const OverlapHypothesis& best = posterior.hypotheses.front();
  const double rival_prob = std::max(0.0, 1.0 - posterior.prob - posterior.none_prob);
  if (posterior.prob < config.join_prob && rival_prob > posterior.none_prob) {
    return "several ways to lay one onto the other are alike: the best has " + percent(posterior.prob);
  }
  if (posterior.prob < config.join_prob) {
    return "too little in common: " + std::to_string(best.landmarks) + " landmarks have counterparts, " +
           std::to_string(best.tiles_found) + " neighbourhoods are found again and " +
           std::to_string(best.tiles_missing) + " are not";
  }
  if (best.landmarks < config.join_landmarks) {
    return "too few landmarks in common: " + std::to_string(best.landmarks);
  }
  if (isWhole(best, a, b, config)) return "";
  const double found = static_cast<double>(best.landmarks) / config.tile_landmarks;
  const double max_share = isDriven(a) && isDriven(b) ? config.max_missing_share : kMaxMissingUndriven;
  if (best.tiles_missing > max_share * (found + best.tiles_missing)) {
    return "too much of what should be in common is missing: " + std::to_string(best.landmarks) +
           " landmarks have counterparts, " + std::to_string(best.tiles_missing) + " neighbourhoods are not found";
  }
  if (best.tiles_found < config.spread_tiles) return "they touch at one place only, which may look like another";
  return "";
}

}  // namespace

OverlapPosterior findOverlap(const MergeMap& a, const MergeMap& b, const MergeSettings& settings,
                             const MergeConfig& config) {
  OverlapPosterior posterior;
  const auto sets = consistentSets(findCandidates(a, b, settings, config), a, b, settings, config);
  for (const auto& set : sets) {
    OverlapHypothesis hypothesis = HypothesisTest(a, b, settings, config).run(set.front());
    const auto is_same = [&](const OverlapHypothesis& known) {
      return isSame(known, hypothesis, a, b, settings, config);
    };
    if (std::any_of(posterior.hypotheses.begin(), posterior.hypotheses.end(), is_same)) continue;
    posterior.hypotheses.push_back(std::move(hypothesis));
  }
  if (posterior.hypotheses.empty()) {
    posterior.reason = "nothing in one looks like anything in the other";
    return posterior;
  }
  std::stable_sort(posterior.hypotheses.begin(), posterior.hypotheses.end(),
                   [](const OverlapHypothesis& x, const OverlapHypothesis& y) { return x.log_odds > y.log_odds; });
  weigh(posterior, config);
  posterior.reason = reasonOf(posterior, a, b, config);
  posterior.is_decided = posterior.reason.empty();
  return posterior;
}

}  // namespace semantic_mht_slam
