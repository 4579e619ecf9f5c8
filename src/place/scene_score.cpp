#include "semantic_mht_slam/place/scene_score.h"

#include <cmath>
#include <vector>

#include <Eigen/Geometry>

#include "semantic_mht_slam/common/assignment.h"

namespace semantic_mht_slam {
namespace {

struct Point {
  Eigen::Vector3d position_m;
  ClassIndex class_index;
};

std::vector<Point> pointsOf(const Scene& scene) {
  std::vector<Point> points;
  points.reserve(scene.objects.size());
  for (const SceneObject& object : scene.objects) points.push_back({object.position_m, object.class_index});
  return points;
}

Eigen::Vector3d centroidOf(const std::vector<Point>& points) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Point& point : points) sum += point.position_m;
  return sum / static_cast<double>(points.size());
}

// Angle of the direction of greatest spread in the horizontal plane, in (-pi/2, pi/2].
double principalYaw(const std::vector<Point>& points) {
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (const Point& point : points) {
    scatter += point.position_m.head<2>() * point.position_m.head<2>().transpose();
  }
  return 0.5 * std::atan2(2.0 * scatter(0, 1), scatter(0, 0) - scatter(1, 1));
}

void turn(double yaw_rad, std::vector<Point>& points) {
  const Eigen::AngleAxisd rotation(yaw_rad, Eigen::Vector3d::UnitZ());
  for (Point& point : points) point.position_m = rotation * point.position_m;
}

std::vector<Point> principalPointsOf(const Scene& scene) {
  std::vector<Point> points = pointsOf(scene);
  const Eigen::Vector3d centroid_m = centroidOf(points);
  for (Point& point : points) point.position_m -= centroid_m;
  turn(-principalYaw(points), points);
  return points;
}

// The printed formula does not tell a good match from a bad one of other classes: both add nearly 1. Which way round
// two scenes fit is therefore judged by similarity.
struct Match {
  double similarity = 0.0;
  double score = 0.0;
};

Match matchOf(const Point& a, const Point& b, double scaled_distance, const SceneScoreConfig& config) {
  const double s_match = 1.0 - scaled_distance / 2.0;
  const double s_class = a.class_index == b.class_index ? 0.0 : config.class_penalty;
  const double similarity = s_match * (1.0 - s_class);
  return {similarity, config.formula == PairScoreFormula::kSimilarity ? similarity : 1.0 - s_match * s_class};
}

// Pairs beyond the largest distance all cost 2 and add alike: one column of its own for each row stands for them, and
// the matrix stays sparse. `rows` has at most as many points as `columns`.
SparseCostMatrix costsOf(const std::vector<Point>& rows, const std::vector<Point>& columns, double max_distance_m) {
  const auto column_count = static_cast<int>(columns.size());
  SparseCostMatrix costs;
  const auto row_count = static_cast<int>(rows.size());
  costs.clear(column_count + row_count);
  for (int i = 0; i < row_count; ++i) {
    costs.addRow();
    for (int j = 0; j < column_count; ++j) {
      const double distance_m = (rows[i].position_m - columns[j].position_m).norm();
      if (distance_m < max_distance_m) costs.add(j, 2.0 * distance_m / max_distance_m);
    }
    costs.add(column_count + i, 2.0);
  }
  return costs;
}

Match matchOf(const std::vector<Point>& rows, const std::vector<Point>& columns, const SceneScoreConfig& config) {
  const SparseCostMatrix costs = costsOf(rows, columns, config.max_distance_m);
  const auto assignment = AssignmentSolver().solve(costs);
  Match sum;
  for (int i = 0; i < costs.rows(); ++i) {
    const std::size_t column = assignment->column_for_row[i];
    if (column >= columns.size()) {
      sum.score += config.formula == PairScoreFormula::kAsPrinted ? 1.0 : 0.0;
      continue;
    }
    const double distance_m = (rows[i].position_m - columns[column].position_m).norm();
    const Match match = matchOf(rows[i], columns[column], 2.0 * distance_m / config.max_distance_m, config);
    sum.similarity += match.similarity;
    sum.score += match.score;
  }
  const auto pairs = static_cast<double>(rows.size());
  return {sum.similarity / pairs, sum.score / pairs};
}

}  // namespace

void describe(SceneScoreConfig& config, Fields& fields) {
  fields.add<SceneFrame>(
      "frame", config.frame, {{"base", SceneFrame::kBase}, {"principal", SceneFrame::kPrincipal}},
      "Frame in which landmarks of two scenes are matched: the sensor's, or the scene's principal axes.");
  fields.add<PairScoreFormula>(
      "formula", config.formula,
      {{"similarity", PairScoreFormula::kSimilarity}, {"as_printed", PairScoreFormula::kAsPrinted}},
      "What a matched pair adds: s_match (1 - s_class), or 1 - s_match s_class as the paper prints it.");
  fields.add("max_distance", config.max_distance_m, "m", {0.01, 1000.0},
             "Distance at which a matched pair of landmarks is as bad as can be.");
  fields.add("class_penalty", config.class_penalty, "", {0.0, 1.0}, "Penalty of a pair of unlike classes.");
  fields.add("min_objects", config.min_objects, "", {1, 1000}, "A scene with less objects has the score 0.");
}

namespace {

// Calls `score` of the smaller scene as it is and turned round, with the larger one; 0 for scenes that are too small.
template <typename Score>
Match betterWayRound(const Scene& a, const Scene& b, const SceneScoreConfig& config, const Score& score) {
  const Scene& smaller = a.objects.size() <= b.objects.size() ? a : b;
  const Scene& larger = a.objects.size() <= b.objects.size() ? b : a;
  const std::size_t min_objects = config.min_objects;
  if (smaller.objects.empty() || smaller.objects.size() < min_objects) return {};
  const bool is_principal = config.frame == SceneFrame::kPrincipal;
  std::vector<Point> turned = is_principal ? principalPointsOf(smaller) : pointsOf(smaller);
  const std::vector<Point> fixed = is_principal ? principalPointsOf(larger) : pointsOf(larger);
  const Match as_it_is = score(turned, fixed, config);
  turn(M_PI, turned);
  const Match turned_round = score(turned, fixed, config);
  return turned_round.similarity > as_it_is.similarity ? turned_round : as_it_is;
}

// Each of `rows` has the one of `columns` that suits it best.
Match bestOfEach(const std::vector<Point>& rows, const std::vector<Point>& columns, const SceneScoreConfig& config) {
  Match sum;
  for (const Point& row : rows) {
    double best = 0.0;
    for (const Point& column : columns) {
      const double squared_m2 = (row.position_m - column.position_m).squaredNorm();
      const double class_factor = row.class_index == column.class_index ? 1.0 : 1.0 - config.class_penalty;
      if (squared_m2 >= config.max_distance_m * config.max_distance_m || class_factor <= best) continue;
      best = std::max(best, (1.0 - std::sqrt(squared_m2) / config.max_distance_m) * class_factor);
    }
    sum.similarity += best;
  }
  sum.similarity /= static_cast<double>(rows.size());
  sum.score = sum.similarity;
  return sum;
}

}  // namespace

double sceneScore(const Scene& a, const Scene& b, const SceneScoreConfig& config) {
  const auto assigned = [](const std::vector<Point>& rows, const std::vector<Point>& columns,
                           const SceneScoreConfig& how) { return matchOf(rows, columns, how); };
  return betterWayRound(a, b, config, assigned).score;
}

double sceneScoreBound(const Scene& a, const Scene& b, const SceneScoreConfig& config) {
  if (config.formula == PairScoreFormula::kAsPrinted) return 1.0;
  constexpr double kScoreRounding = 1e-9;
  return std::min(1.0, betterWayRound(a, b, config, bestOfEach).score + kScoreRounding);
}

}  // namespace semantic_mht_slam
