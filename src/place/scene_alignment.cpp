#include "semantic_mht_slam/place/scene_alignment.h"

#include <algorithm>
#include <cmath>

#include "scene_correspondences.h"
#include "scene_fit.h"
#include "scene_pose.h"
#include "scene_votes.h"

namespace semantic_mht_slam {
namespace {

constexpr std::size_t kMaxJudged = 4;
constexpr std::size_t kMaxReturned = 2;

bool areDistinct(const PlanarFit& a, const PlanarFit& b, const SceneAlignmentConfig& config) {
  return (a.motion.shift_m - b.motion.shift_m).norm() > config.distinct_m ||
         std::cos(a.motion.yaw_rad - b.motion.yaw_rad) < std::cos(config.distinct_rad);
}

std::vector<PlanarGuess> guessMotions(const PlanarScene& query, const PlanarScene& match,
                                      const SceneAlignmentConfig& config) {
  switch (config.search) {
    case AlignmentSearch::kClique:
      return guessByCliques(query, match);
    case AlignmentSearch::kRansac:
      return guessByRansac(query, match);
    case AlignmentSearch::kVotes:
      break;
  }
  return voteForMotions(query, match, config.max_offset_m, config.max_guesses);
}

bool isWithinReach(const PlanarScene& query, const PlanarScene& match, const PlanarFit& fit, double max_offset_m) {
  return moved(fit.motion, query, match, Eigen::Vector2d::Zero()).norm() <= max_offset_m;
}

/// Refined guesses, the most promising first.
std::vector<PlanarFit> refinedGuesses(const PlanarScene& query, const PlanarScene& match,
                                      const std::vector<bool>& is_static, const SceneAlignmentConfig& config) {
  std::vector<PlanarFit> fits;
  for (const PlanarGuess& guess : guessMotions(query, match, config)) {
    PlanarFit fit = refineMotion(query, match, guess, is_static, config);
    if (isWithinReach(query, match, fit, config.max_offset_m)) fits.push_back(std::move(fit));
  }
  std::stable_sort(fits.begin(), fits.end(),
                   [](const PlanarFit& a, const PlanarFit& b) { return a.quick_score > b.quick_score; });
  return fits;
}

/// The best distinct fits, judged.
std::vector<PlanarFit> judgedFits(const PlanarScene& query, const PlanarScene& match, const ClassTable& classes,
                                  const SceneAlignmentConfig& config) {
  std::vector<bool> is_static;
  for (const ClassInfo& info : classes.all()) is_static.push_back(info.is_static);
  std::vector<PlanarFit> judged;
  for (PlanarFit& fit : refinedGuesses(query, match, is_static, config)) {
    const bool is_new = std::all_of(judged.begin(), judged.end(),
                                    [&](const PlanarFit& other) { return areDistinct(fit, other, config); });
    if (!is_new) continue;
    judgeFit(query, match, is_static, config, fit);
    judged.push_back(std::move(fit));
    if (judged.size() == kMaxJudged) break;
  }
  std::stable_sort(judged.begin(), judged.end(),
                   [](const PlanarFit& a, const PlanarFit& b) { return a.similarity > b.similarity; });
  return judged;
}

}  // namespace

void describe(SceneAlignmentConfig& config, Fields& fields) {
  using Search = AlignmentSearch;
  fields.add("search", config.search,
             {{"votes", Search::kVotes}, {"clique", Search::kClique}, {"ransac", Search::kRansac}},
             "First guesses: votes of object pairs, maximum clique of correspondences, or random samples (PCL).");
  fields.add("max_offset", config.max_offset_m, "m", {0.1, 60.0},
             "Two keyframes further apart than this are not compared as one place.");
  fields.add("max_guesses", config.max_guesses, "", {1, 1000}, "Guesses of `votes` that are refined.");
  fields.add("noise_floor", config.noise_floor_m, "m", {0.001, 10.0},
             "Deviation of a centroid between two passes on top of its covariance.");
  fields.add("full_residual", config.full_residual_m, "m", {0.01, 10.0},
             "Objects nearer than this to their counterpart count fully as inliers.");
  fields.add("static_match_prob", config.static_match_prob, "", {0.01, 0.99},
             "Probability that a static object of a place is seen again.");
  fields.add("movable_match_prob", config.movable_match_prob, "", {0.01, 0.99},
             "The same of an object that may drive away.");
  fields.add("movable_weight", config.movable_weight, "", {0.0, 1.0}, "What an object that may drive away counts.");
  fields.add("density_floor", config.density_floor_per_m2, "1/m^2", {1e-6, 10.0},
             "Least density of the objects of a class, for the evidence of a match.");
  fields.add("distinct_distance", config.distinct_m, "m", {0.01, 100.0}, "Alignments further apart are two.");
  fields.add("distinct_angle", config.distinct_rad, "rad", {0.001, 3.0}, "Alignments turned further are two.");
  fields.add("tilt_stddev", config.tilt_stddev_rad, "rad", {1e-4, 1.0},
             "Roll and pitch between two keyframes of a place.");
  fields.add("height_stddev", config.height_stddev_m, "m", {1e-3, 100.0},
             "Deviation of a centroid's height between two passes on top of its covariance.");
}

std::vector<SceneAlignment> alignScenes(const PlanarScene& query, const PlanarScene& match, const ClassTable& classes,
                                        const SceneAlignmentConfig& config) {
  std::vector<SceneAlignment> result;
  for (const PlanarFit& fit : judgedFits(query, match, classes, config)) {
    if (fit.pairs.empty() || result.size() == kMaxReturned) break;
    result.push_back(toAlignment(query, match, fit, config));
  }
  return result;
}

}  // namespace semantic_mht_slam
