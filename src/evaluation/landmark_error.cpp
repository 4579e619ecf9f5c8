#include "semantic_mht_slam/evaluation/landmark_error.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <tuple>

#include "semantic_mht_slam/evaluation/planar_grid.h"
#include "semantic_mht_slam/evaluation/statistics.h"

namespace semantic_mht_slam {
namespace {

void requireUsable(const std::vector<PointLandmark>& landmarks) {
  for (const PointLandmark& landmark : landmarks) {
    if (!landmark.position_m.allFinite()) throw std::invalid_argument("a landmark's position is not finite");
  }
}

void requireUsable(const LandmarkComparison& comparison) {
  if (!(comparison.radius_m > 0.0)) throw std::invalid_argument("the radius of landmarks is not positive");
  if (comparison.driven_length_m <= 0.0) throw std::invalid_argument("the driven length is not positive");
}

std::vector<PointLandmark> moved(std::vector<PointLandmark> landmarks, const Pose& T_target_source) {
  for (PointLandmark& landmark : landmarks) landmark.position_m = T_target_source * landmark.position_m;
  return landmarks;
}

bool mayBeSame(const PointLandmark& a, const PointLandmark& b, const LandmarkComparison& comparison) {
  return !comparison.match_class || a.class_name.empty() || b.class_name.empty() || a.class_name == b.class_name;
}

/// Every pair that may be the same landmark, by rising distance.
std::vector<LandmarkMatch> candidates(const std::vector<PointLandmark>& truth, const std::vector<PointLandmark>& map,
                                      const LandmarkComparison& comparison) {
  std::vector<Eigen::Vector2d> points_m;
  points_m.reserve(truth.size());
  for (const PointLandmark& landmark : truth) points_m.emplace_back(landmark.position_m.head<2>());
  const PlanarGrid grid(points_m, comparison.radius_m);
  std::vector<LandmarkMatch> result;
  for (std::size_t mapped = 0; mapped < map.size(); ++mapped) {
    const Eigen::Vector2d center_m = map[mapped].position_m.head<2>();
    grid.anyNear(center_m, [&](std::size_t index) {
      const double distance_m = (points_m[index] - center_m).norm();
      if (distance_m <= comparison.radius_m && mayBeSame(truth[index], map[mapped], comparison)) {
        result.push_back({index, mapped, distance_m});
      }
      return false;
    });
  }
  std::sort(result.begin(), result.end(), [](const LandmarkMatch& a, const LandmarkMatch& b) {
    return std::tie(a.distance_m, a.truth, a.mapped) < std::tie(b.distance_m, b.truth, b.mapped);
  });
  return result;
}

/// Matches the nearest pairs first and counts the mapped landmarks that are left.
void addMatches(const std::vector<LandmarkMatch>& pairs, LandmarkError& error) {
  std::vector<bool> truth_taken(error.true_landmarks, false);
  std::vector<bool> mapped_taken(error.mapped_landmarks, false);
  std::vector<bool> is_near(error.mapped_landmarks, false);
  for (const LandmarkMatch& pair : pairs) {
    is_near[pair.mapped] = true;
    if (truth_taken[pair.truth] || mapped_taken[pair.mapped]) continue;
    truth_taken[pair.truth] = true;
    mapped_taken[pair.mapped] = true;
    error.matches.push_back(pair);
  }
  const auto near = static_cast<std::size_t>(std::count(is_near.begin(), is_near.end(), true));
  error.duplicates = near - error.matches.size();
  error.ghosts = error.mapped_landmarks - near;
}

void addPositionErrors(const std::vector<PointLandmark>& truth, const std::vector<PointLandmark>& map,
                       LandmarkError& error) {
  std::vector<double> distances_m;
  std::vector<double> heights_m;
  for (const LandmarkMatch& match : error.matches) {
    distances_m.push_back(match.distance_m);
    const PointLandmark& a = truth[match.truth];
    const PointLandmark& b = map[match.mapped];
    if (a.has_height && b.has_height) heights_m.push_back(b.position_m.z() - a.position_m.z());
  }
  error.rmse_m = rootMeanSquare(distances_m);
  error.median_m = median(distances_m);
  error.height_rmse_m = rootMeanSquare(heights_m);
}

double ratio(std::size_t part, std::size_t whole) {
  return whole == 0 ? LandmarkError::kUndefined : static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace

LandmarkError landmarkError(const std::vector<PointLandmark>& truth, const std::vector<PointLandmark>& map,
                            const LandmarkComparison& comparison) {
  requireUsable(truth);
  requireUsable(map);
  requireUsable(comparison);
  const std::vector<PointLandmark> aligned = moved(map, comparison.T_truth_map);
  LandmarkError error;
  error.true_landmarks = truth.size();
  error.mapped_landmarks = map.size();
  addMatches(candidates(truth, aligned, comparison), error);
  addPositionErrors(truth, aligned, error);
  error.recall = ratio(error.matches.size(), truth.size());
  error.precision = ratio(error.matches.size(), map.size());
  error.duplicates_per_true = ratio(error.duplicates, truth.size());
  error.ghosts_per_km = static_cast<double>(error.ghosts) / (comparison.driven_length_m / 1000.0);
  return error;
}

}  // namespace semantic_mht_slam
