#include "scene_fit.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "semantic_mht_slam/common/assignment.h"

namespace semantic_mht_slam {
namespace {

constexpr std::array<double, 6> kReach_m = {3.0, 2.5, 2.0, 1.5, 1.5, 1.5};
constexpr double kMaxHeightGap_m = 2.5;
constexpr double kGate = 3.0;  // standard deviations

Eigen::Matrix2d turn(double yaw_rad) {
  return Eigen::Rotation2Dd(yaw_rad).toRotationMatrix();
}

/// Nearest object of the class in the match; -1 beyond the reach.
int nearest(const PlanarScene& match, const PlanarObject& object, const Eigen::Vector2d& point_m, double reach_m) {
  int best = -1;
  double best_sq = reach_m * reach_m;
  for (int j = match.class_begin[object.class_index]; j < match.class_begin[object.class_index + 1]; ++j) {
    const double distance_sq = (match.objects[j].position_m - point_m).squaredNorm();
    if (distance_sq >= best_sq) continue;
    if (std::abs(match.objects[j].height_m - object.height_m) > kMaxHeightGap_m) continue;
    best = j;
    best_sq = distance_sq;
  }
  return best;
}

/// Weighted sums of corresponding points.
struct Correspondences {
  double weight = 0.0;
  Eigen::Vector2d source_m = Eigen::Vector2d::Zero();
  Eigen::Vector2d target_m = Eigen::Vector2d::Zero();
  Eigen::Matrix2d product_m2 = Eigen::Matrix2d::Zero();

  void add(const Eigen::Vector2d& source, const Eigen::Vector2d& target, double w) {
    weight += w;
    source_m += w * source;
    target_m += w * target;
    product_m2 += w * target * source.transpose();
  }

  /// Least squares; points are relative to the centres.
  PlanarGuess solve() const {
    const Eigen::Vector2d s = source_m / weight;
    const Eigen::Vector2d t = target_m / weight;
    const Eigen::Matrix2d m = product_m2 - weight * t * s.transpose();
    PlanarGuess motion;
    motion.yaw_rad = std::atan2(m(1, 0) - m(0, 1), m(0, 0) + m(1, 1));
    motion.shift_m = t - turn(motion.yaw_rad) * s;
    return motion;
  }
};

}  // namespace

Eigen::Vector2d moved(const PlanarGuess& motion, const PlanarScene& query, const PlanarScene& match,
                      const Eigen::Vector2d& point_m) {
  return turn(motion.yaw_rad) * (point_m - query.centre_m) + match.centre_m + motion.shift_m;
}

PlanarFit refineMotion(const PlanarScene& query, const PlanarScene& match, const PlanarGuess& guess,
                       const std::vector<bool>& is_static, const SceneAlignmentConfig& config) {
  PlanarFit fit;
  fit.motion = guess;
  for (const double reach_m : kReach_m) {
    const Eigen::Matrix2d rotation = turn(fit.motion.yaw_rad);
    const Eigen::Vector2d offset_m = match.centre_m + fit.motion.shift_m - rotation * query.centre_m;
    Correspondences sums;
    int count = 0;
    fit.quick_score = 0.0;
    for (const PlanarObject& object : query.objects) {
      const Eigen::Vector2d point_m = rotation * object.position_m + offset_m;
      const int j = nearest(match, object, point_m, reach_m);
      if (j < 0) continue;
      const PlanarObject& other = match.objects[j];
      const double distance_sq = (other.position_m - point_m).squaredNorm();
      const double variance_m2 = object.variance_m2 + other.variance_m2;
      const double robust = 1.0 / (1.0 + distance_sq / (4.0 * variance_m2));
      sums.add(object.position_m - query.centre_m, other.position_m - match.centre_m, robust * robust / variance_m2);
      ++count;
      const double kind = is_static[object.class_index] ? 1.0 : config.movable_weight;
      fit.quick_score += kind * robust * robust;
    }
    if (count < 2) break;
    fit.motion = sums.solve();
  }
  return fit;
}

namespace {

/// How much likelier two objects are the same than near each other by chance.
struct Lift {
  double log_odds = 0.0;
  double weight = 0.0;
};

Lift liftOf(const PlanarObject& object, const PlanarObject& other, double distance_sq, bool is_static,
            const SceneAlignmentConfig& config) {
  Lift lift;
  const double variance_m2 = object.variance_m2 + other.variance_m2;
  if (distance_sq > kGate * kGate * variance_m2) return lift;
  if (std::abs(object.height_m - other.height_m) > kMaxHeightGap_m) return lift;
  const double density = std::max({object.density_per_m2, other.density_per_m2, config.density_floor_per_m2});
  const double prob = is_static ? config.static_match_prob : config.movable_match_prob;
  const double near = std::exp(-0.5 * distance_sq / variance_m2) / (2.0 * M_PI * variance_m2);
  lift.log_odds = std::log(1.0 - prob + prob * near / density) - std::log(1.0 - prob);
  const double beyond_m = std::max(0.0, std::sqrt(distance_sq) - config.full_residual_m);
  lift.weight = std::exp(-0.5 * beyond_m * beyond_m / (config.full_residual_m * config.full_residual_m));
  return lift;
}

}  // namespace

void judgeFit(const PlanarScene& query, const PlanarScene& match, const std::vector<bool>& is_static,
              const SceneAlignmentConfig& config, PlanarFit& fit) {
  SparseCostMatrix costs;
  costs.clear(match.size() + query.size());
  std::vector<Lift> lifts;  // one an entry
  for (int i = 0; i < query.size(); ++i) {
    const PlanarObject& object = query.objects[i];
    const Eigen::Vector2d point_m = moved(fit.motion, query, match, object.position_m);
    costs.addRow();
    for (int j = match.class_begin[object.class_index]; j < match.class_begin[object.class_index + 1]; ++j) {
      const double distance_sq = (match.objects[j].position_m - point_m).squaredNorm();
      const Lift lift = liftOf(object, match.objects[j], distance_sq, is_static[object.class_index], config);
      if (lift.log_odds <= 0.0) continue;
      costs.add(j, -lift.log_odds);
      lifts.push_back(lift);
    }
    costs.add(match.size() + i, 0.0);
    lifts.push_back({});
  }
  AssignmentSolver solver;
  const auto assignment = solver.solve(costs);
  if (!assignment) return;
  double total = 0.0;
  double other_total = 0.0;
  for (int i = 0; i < query.size(); ++i) {
    const bool stays = is_static[query.objects[i].class_index];
    const double kind = stays ? 1.0 : config.movable_weight;
    total += kind;
    double gain = std::log(1.0 - (stays ? config.static_match_prob : config.movable_match_prob));
    const int j = assignment->column_for_row[i];
    for (int e = costs.rowBegin(i); e < costs.rowEnd(i); ++e) {
      if (costs.column(e) != j || j >= match.size()) continue;
      gain += lifts[e].log_odds;
      fit.pairs.push_back({i, j, lifts[e].weight});
      fit.soft_inliers += kind * lifts[e].weight;
      if (stays) fit.static_inliers += lifts[e].weight;
    }
    fit.log_evidence += kind * gain;
    if (stays) fit.log_static_evidence += gain;
  }
  for (const PlanarObject& object : match.objects)
    other_total += is_static[object.class_index] ? 1.0 : config.movable_weight;
  const double smaller = std::min(total, other_total);
  if (smaller > 0.0) fit.similarity = fit.soft_inliers * fit.soft_inliers / smaller;
}

}  // namespace semantic_mht_slam
