#include "semantic_mht_slam/place/scene_alignment.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <Eigen/Eigenvalues>

namespace semantic_mht_slam {
namespace {

double spreadAcross(const Scene& query, const std::vector<RegisteredPair>& pairs) {
  if (pairs.size() < 2) return 0.0;
  const double count = static_cast<double>(pairs.size());
  Eigen::Vector2d mean_m = Eigen::Vector2d::Zero();
  for (const RegisteredPair& pair : pairs) mean_m += query.objects[pair.b].position_m.head<2>() / count;
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (const RegisteredPair& pair : pairs) {
    const Eigen::Vector2d from_mean_m = query.objects[pair.b].position_m.head<2>() - mean_m;
    scatter += from_mean_m * from_mean_m.transpose() / count;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(scatter, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, solver.eigenvalues()(0)));
}

/// What the objects of a scene count in all.
double countOf(const Scene& scene, const ClassTable& classes, double movable_weight) {
  int movable = 0;
  for (const SceneObject& object : scene.objects) movable += classes[object.class_index].is_static ? 0 : 1;
  return static_cast<double>(scene.objects.size()) - (1.0 - movable_weight) * movable;
}

SceneAlignment scored(RegistrationMode mode, const Scene& query, const Scene& match, const ClassTable& classes,
                      const PlaceConfig& config) {
  SceneAlignment result;
  std::set<ClassIndex> pair_classes;
  for (const RegisteredPair& pair : mode.pairs) {
    const SceneObject& object = query.objects[pair.b];
    const Eigen::Vector3d apart_m = mode.T_a_b * object.position_m - match.objects[pair.a].position_m;
    const double beyond = std::max(0.0, apart_m.head<2>().norm() / config.full_residual_m - 1.0);
    const double weight = std::exp(-0.5 * beyond * beyond);
    const bool is_static = classes[object.class_index].is_static;
    result.soft_inliers += (is_static ? 1.0 : config.movable_weight) * weight;
    if (is_static) result.static_inliers += weight;
    pair_classes.insert(object.class_index);
  }
  const double smaller =
      std::min(countOf(query, classes, config.movable_weight), countOf(match, classes, config.movable_weight));
  if (smaller > 0.0) result.similarity = result.soft_inliers * result.soft_inliers / smaller;
  result.spread_m = spreadAcross(query, mode.pairs);
  result.pair_classes = static_cast<int>(pair_classes.size());
  result.mode = std::move(mode);
  return result;
}

double largestHorizontalStddev(const Eigen::Matrix<double, 6, 6>& cov) {
  const Eigen::Matrix2d horizontal = cov.topLeftCorner<2, 2>();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(horizontal, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, solver.eigenvalues()(1)));
}

}  // namespace

std::vector<SceneAlignment> alignScenes(const Scene& query, const Scene& match, const ClassTable& classes,
                                        const RegistrationConfig& registration, const PlaceConfig& config) {
  std::vector<SceneAlignment> result;
  for (RegistrationMode& mode :
       align(registrationPoints(match), registrationPoints(query), std::nullopt, classes, registration)) {
    result.push_back(scored(std::move(mode), query, match, classes, config));
  }
  std::stable_sort(result.begin(), result.end(),
                   [](const SceneAlignment& a, const SceneAlignment& b) { return a.similarity > b.similarity; });
  return result;
}

double rivalSimilarity(const std::vector<SceneAlignment>& alignments, const PlaceConfig& config) {
  for (const SceneAlignment& other : alignments) {
    const Pose step = alignments.front().mode.T_a_b.inverse() * other.mode.T_a_b;
    const bool is_same =
        step.translation_m.head<2>().norm() < config.agree_m && logRotation(step.rotation).norm() < config.agree_rad;
    if (!is_same) return other.similarity;
  }
  return -1.0;
}

PlaceRefusal checkAlignment(const SceneAlignment& alignment, double rival_score, const PlaceConfig& config) {
  const std::size_t min_inliers = config.min_inliers;
  if (alignment.mode.pairs.size() < min_inliers) return PlaceRefusal::kFewInliers;
  if (alignment.pair_classes < config.min_classes) return PlaceRefusal::kFewClasses;
  if (alignment.spread_m < config.min_spread_m) return PlaceRefusal::kOnALine;
  if (largestHorizontalStddev(alignment.mode.cov) > config.max_stddev_m ||
      std::sqrt(alignment.mode.cov(5, 5)) > config.max_stddev_rad) {
    return PlaceRefusal::kUncertain;
  }
  if (alignment.similarity < config.supported_score ||
      alignment.similarity < config.min_share * alignment.soft_inliers ||
      alignment.mode.log_evidence < config.min_log_evidence) {
    return PlaceRefusal::kLowScore;
  }
  if (rival_score > config.rival_ratio * alignment.similarity) return PlaceRefusal::kAmbiguous;
  return PlaceRefusal::kNone;
}

}  // namespace semantic_mht_slam
