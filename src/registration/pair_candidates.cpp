#include "pair_candidates.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/LU>

#include "semantic_mht_slam/common/gaussian.h"

namespace semantic_mht_slam {
namespace {

constexpr double kImpossible = -std::numeric_limits<double>::infinity();

/// log P(seen | true) of two classes. Only classes that are both static or both movable are mistaken for each other.
std::vector<std::vector<double>> logClassProbs(const std::vector<bool>& is_static, double confusion_prob) {
  const std::size_t classes = is_static.size();
  std::vector<std::vector<double>> result(classes, std::vector<double>(classes, kImpossible));
  for (std::size_t truth = 0; truth < classes; ++truth) {
    const auto others = std::count(is_static.begin(), is_static.end(), is_static[truth]) - 1;
    for (std::size_t seen = 0; seen < classes; ++seen) {
      if (is_static[seen] != is_static[truth]) continue;
      const double confused_prob = others > 0 ? confusion_prob : 0.0;
      result[truth][seen] = std::log(seen == truth ? 1.0 - confused_prob : confused_prob / static_cast<double>(others));
    }
  }
  return result;
}

/// What bounds the reach of matches with a point.
struct Spread {
  double det = std::numeric_limits<double>::infinity();  ///< of its covariance
  double largest_variance_m2 = 0.0;                      ///< horizontal
};

Spread spreadOf(const Eigen::Matrix3d& cov_m2) {
  const double mean = 0.5 * (cov_m2(0, 0) + cov_m2(1, 1));
  return {cov_m2.determinant(), mean + std::hypot(0.5 * (cov_m2(0, 0) - cov_m2(1, 1)), cov_m2(0, 1))};
}

/// Horizontal distance beyond which a match is no better than none, whatever the heading; negative if there is no such
/// match. Bounds the density by det(A + B) >= det A + det B and the distance by the largest eigenvalues.
double reach(const Spread& detection, const Spread& landmark, double log_odds) {
  const double log_peak_odds = log_odds - 0.5 * (3.0 * kLogTwoPi + std::log(detection.det + landmark.det));
  if (log_peak_odds <= 0.0) return -1.0;
  return std::sqrt(2.0 * log_peak_odds * (detection.largest_variance_m2 + landmark.largest_variance_m2));
}

using Points = std::vector<LevelledPoint>::const_iterator;

/// The landmarks of a class, which are sorted by x, and the spread of one that would reach as far as any of them: most
/// pairs are too far apart for a match.
struct ClassLandmarks {
  Points begin;
  Points end;
  Spread farthest;

  /// The first one from `x_m` on.
  Points firstFrom(double x_m) const {
    return std::lower_bound(begin, end, x_m, [](const LevelledPoint& p, double x) { return p.position_m.x() < x; });
  }
};

std::vector<ClassLandmarks> landmarksByClass(const RegistrationProblem& problem, const std::vector<Spread>& spreads) {
  const std::vector<LevelledPoint>& landmarks = problem.landmarks;
  std::vector<ClassLandmarks> result;
  Points end = landmarks.begin();
  for (std::size_t c = 0; c < problem.is_static.size(); ++c) {
    ClassLandmarks known{end, end, {}};
    for (; end != landmarks.end() && end->class_index == static_cast<ClassIndex>(c); ++end) {
      const Spread& spread = spreads[end - landmarks.begin()];
      known.farthest.det = std::min(known.farthest.det, spread.det);
      known.farthest.largest_variance_m2 = std::max(known.farthest.largest_variance_m2, spread.largest_variance_m2);
    }
    known.end = end;
    result.push_back(known);
  }
  return result;
}

/// Landmarks of each class per cubic metre around where the detections of that class are expected, or, if that may be
/// anywhere, around themselves. Counted there and not over the whole map, because objects stand in rows along streets
/// and chance matches are as frequent as the rows are dense.
std::vector<double> classDensities(const RegistrationProblem& problem, const std::vector<ClassLandmarks>& by_class,
                                   const RegistrationConfig& config) {
  const double radius_m = config.density_radius_m;
  std::vector<int> counted(by_class.size(), 0);
  std::vector<int> neighbours(by_class.size(), 0);
  const std::vector<LevelledPoint>& centres = problem.prior.is_open ? problem.landmarks : problem.detections;
  for (const LevelledPoint& centre : centres) {
    const ClassIndex c = centre.class_index;
    ++counted[c];
    const double x_end_m = centre.position_m.x() + radius_m;
    Points landmark = by_class[c].firstFrom(centre.position_m.x() - radius_m);
    for (; landmark != by_class[c].end && landmark->position_m.x() <= x_end_m; ++landmark) {
      const double distance_sq = (landmark->position_m - centre.position_m).head<2>().squaredNorm();
      if (distance_sq < radius_m * radius_m) ++neighbours[c];
    }
  }
  const double volume_m3 = M_PI * radius_m * radius_m * config.density_height_m;
  std::vector<double> densities;
  for (std::size_t c = 0; c < by_class.size(); ++c) {
    densities.push_back(std::max(1.0, neighbours[c] / std::max(1.0, 1.0 * counted[c])) / volume_m3);
  }
  return densities;
}

/// Largest gaps that offsets inside the window can close for a detection.
Eigen::Vector3d closable(const LevelledPoint& detection, const Eigen::Vector4d& window) {
  const double turn_m = std::min(2.0, window(3)) * detection.position_m.head<2>().norm();
  return window.head<3>() + Eigen::Vector3d(turn_m, turn_m, 0.0);
}

bool isWithin(const Eigen::Vector3d& gap_m, const Eigen::Vector3d& closable_m, double reach_m) {
  return std::abs(gap_m.x()) < closable_m.x() + reach_m && std::abs(gap_m.y()) < closable_m.y() + reach_m &&
         std::abs(gap_m.z()) < closable_m.z() + reach_m;
}

/// What the candidates of all detections depend on.
struct CandidateSearch {
  std::vector<Spread> spreads;  ///< of the landmarks
  std::vector<ClassLandmarks> by_class;
  std::vector<double> densities;
  std::vector<std::vector<double>> log_class_probs;
};

/// Landmarks that a detection may be; `log_odds` is what holds for all of them.
std::vector<PairCandidate> findCandidates(const RegistrationProblem& problem, const CandidateSearch& search,
                                          const LevelledPoint& detection, double log_odds) {
  const Eigen::Vector3d closable_m = closable(detection, problem.prior.window);
  const Spread spread = spreadOf(detection.cov_m2);
  std::vector<PairCandidate> candidates;
  if (problem.prior.is_open) candidates.reserve(problem.landmarks.size());
  for (std::size_t c = 0; c < search.by_class.size(); ++c) {
    const double log_class_prob = search.log_class_probs[c][detection.class_index];
    const ClassLandmarks& known = search.by_class[c];
    const double farthest_m = reach(spread, known.farthest, log_odds + log_class_prob);
    if (log_class_prob == kImpossible || farthest_m <= 0.0) continue;
    const double farthest_x_m = closable_m.x() + farthest_m;
    const double x_end_m = detection.position_m.x() + farthest_x_m;
    Points landmark = known.firstFrom(detection.position_m.x() - farthest_x_m);
    for (; landmark != known.end && landmark->position_m.x() <= x_end_m; ++landmark) {
      const Eigen::Vector3d gap_m = landmark->position_m - detection.position_m;
      if (!isWithin(gap_m, closable_m, farthest_m)) continue;
      PairCandidate candidate;
      candidate.landmark = static_cast<int>(landmark - problem.landmarks.begin());
      candidate.is_same_class = static_cast<ClassIndex>(c) == detection.class_index;
      candidate.log_odds = log_odds + log_class_prob;
      candidate.reach_m = reach(spread, search.spreads[candidate.landmark], candidate.log_odds);
      if (candidate.reach_m > 0.0 && isWithin(gap_m, closable_m, candidate.reach_m)) candidates.push_back(candidate);
    }
  }
  return candidates;
}

}  // namespace

std::vector<std::vector<PairCandidate>> pairCandidates(const RegistrationProblem& problem,
                                                       const RegistrationConfig& config) {
  CandidateSearch search;
  for (const LevelledPoint& landmark : problem.landmarks) search.spreads.push_back(spreadOf(landmark.cov_m2));
  search.by_class = landmarksByClass(problem, search.spreads);
  search.densities = classDensities(problem, search.by_class, config);
  search.log_class_probs = logClassProbs(problem.is_static, config.confusion_prob);
  std::vector<std::vector<PairCandidate>> candidates;
  for (const LevelledPoint& detection : problem.detections) {
    const ClassIndex c = detection.class_index;
    const double match_prob = problem.is_static[c] ? config.static_match_prob : config.movable_match_prob;
    const double log_odds = std::log(match_prob / (1.0 - match_prob)) - std::log(search.densities[c]);
    candidates.push_back(findCandidates(problem, search, detection, log_odds));
  }
  return candidates;
}

}  // namespace semantic_mht_slam
