#include "scene_pose.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace semantic_mht_slam {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Jacobian = Eigen::Matrix<double, 3, 6>;

constexpr int kSteps = 4;

Eigen::Vector3d inSpace(const PlanarObject& object) {
  return {object.position_m.x(), object.position_m.y(), object.height_m};
}

Eigen::Matrix3d cross(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

/// A pair in the frame of the query, where steps are small motions on the right of T_match_query.
struct PairInQuery {
  Eigen::Vector3d gap_m;  // from the object of the query to that of the match
  Jacobian jacobian;      // of where the object of the query goes
  Eigen::Matrix3d cov_m2;
  Eigen::Matrix3d map_cov_m2;
};

std::vector<PairInQuery> pairsInQuery(const PlanarScene& query, const PlanarScene& match, const PlanarFit& fit,
                                      const Pose& T_match_query, double height_stddev_m) {
  const Pose T_query_match = T_match_query.inverse();
  const Eigen::Matrix3d R_query_match = T_query_match.rotation.toRotationMatrix();
  std::vector<PairInQuery> result;
  for (const AlignedPair& pair : fit.pairs) {
    const PlanarObject& object = query.objects[pair.query];
    const PlanarObject& other = match.objects[pair.match];
    PairInQuery item;
    item.gap_m = T_query_match * inSpace(other) - inSpace(object);
    item.jacobian << Eigen::Matrix3d::Identity(), -cross(inSpace(object));
    item.cov_m2 = object.cov_m2 + R_query_match * other.cov_m2 * R_query_match.transpose();
    item.cov_m2(2, 2) += height_stddev_m * height_stddev_m;
    item.map_cov_m2 = object.map_cov_m2 + R_query_match * other.map_cov_m2 * R_query_match.transpose();
    result.push_back(item);
  }
  return result;
}

/// Keeps a problem without any heights solvable: z is as open as the tilt allows.
Matrix6 priorInformation(const SceneAlignmentConfig& config) {
  Vector6 diagonal = Vector6::Constant(1e-6);
  diagonal(3) = diagonal(4) = 1.0 / (config.tilt_stddev_rad * config.tilt_stddev_rad);
  return diagonal.asDiagonal();
}

Pose planarStart(const PlanarScene& query, const PlanarScene& match, const PlanarFit& fit) {
  Pose T_match_query;
  T_match_query.rotation = expRotation({0.0, 0.0, fit.motion.yaw_rad});
  T_match_query.translation_m.head<2>() = moved(fit.motion, query, match, Eigen::Vector2d::Zero());
  double climb_m = 0.0;
  for (const AlignedPair& pair : fit.pairs) {
    climb_m += match.objects[pair.match].height_m - query.objects[pair.query].height_m;
  }
  if (!fit.pairs.empty()) T_match_query.translation_m.z() = climb_m / static_cast<double>(fit.pairs.size());
  return T_match_query;
}

/// Mapped landmarks of one scene have an error in common, that of the map there: what a mean over them keeps, however
/// many there are.
Eigen::Matrix3d commonCov(const std::vector<PairInQuery>& pairs) {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  int mapped = 0;
  for (const PairInQuery& pair : pairs) {
    if (pair.map_cov_m2.trace() <= 0.0) continue;
    information += pair.map_cov_m2.inverse();
    ++mapped;
  }
  if (mapped == 0) return Eigen::Matrix3d::Zero();
  return mapped * information.inverse();
}

/// Sandwich covariance of the least-squares estimate: weights include the common errors, the spread does not.
Matrix6 estimateCov(const std::vector<PairInQuery>& pairs, const Matrix6& prior) {
  Matrix6 information = prior;
  Matrix6 spread = prior;
  for (const PairInQuery& pair : pairs) {
    const Eigen::Matrix3d weight = pair.cov_m2.inverse();
    const Jacobian whitened = weight * pair.jacobian;
    information += pair.jacobian.transpose() * whitened;
    spread += whitened.transpose() * (pair.cov_m2 - pair.map_cov_m2) * whitened;
  }
  const Matrix6 inverse = information.ldlt().solve(Matrix6::Identity());
  Matrix6 cov = inverse * spread * inverse;
  cov.topLeftCorner<3, 3>() += commonCov(pairs);
  return 0.5 * (cov + cov.transpose());
}

double spreadAcross(const PlanarScene& query, const std::vector<AlignedPair>& pairs) {
  if (pairs.size() < 2) return 0.0;
  Eigen::Vector2d mean_m = Eigen::Vector2d::Zero();
  for (const AlignedPair& pair : pairs) mean_m += query.objects[pair.query].position_m;
  mean_m /= static_cast<double>(pairs.size());
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (const AlignedPair& pair : pairs) {
    const Eigen::Vector2d from_mean_m = query.objects[pair.query].position_m - mean_m;
    scatter += from_mean_m * from_mean_m.transpose() / static_cast<double>(pairs.size());
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(scatter, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, solver.eigenvalues()(0)));
}

}  // namespace

SceneAlignment toAlignment(const PlanarScene& query, const PlanarScene& match, const PlanarFit& fit,
                           const SceneAlignmentConfig& config) {
  SceneAlignment result;
  Pose T_match_query = planarStart(query, match, fit);
  const Matrix6 prior = priorInformation(config);
  for (int step = 0; step < kSteps; ++step) {
    Matrix6 information = prior;
    const Eigen::Vector3d up = T_match_query.rotation.inverse() * Eigen::Vector3d::UnitZ();
    Vector6 right_side = Vector6::Zero();  // turning by (up.y, -up.x) brings `up` back to z
    right_side(3) = prior(3, 3) * up.y();
    right_side(4) = -prior(4, 4) * up.x();
    for (const PairInQuery& pair : pairsInQuery(query, match, fit, T_match_query, config.height_stddev_m)) {
      const Eigen::Matrix3d weight = pair.cov_m2.inverse();
      information += pair.jacobian.transpose() * weight * pair.jacobian;
      right_side += pair.jacobian.transpose() * weight * pair.gap_m;
    }
    const Vector6 change = information.ldlt().solve(right_side);
    T_match_query = normalized(T_match_query * Pose{expRotation(change.tail<3>()), change.head<3>()});
  }
  result.T_match_query = T_match_query;
  result.cov = estimateCov(pairsInQuery(query, match, fit, T_match_query, config.height_stddev_m), prior);
  std::set<ClassIndex> classes;
  for (const AlignedPair& pair : fit.pairs) {
    result.pairs.push_back({query.objects[pair.query].index, match.objects[pair.match].index, pair.weight});
    classes.insert(query.objects[pair.query].class_index);
  }
  std::sort(result.pairs.begin(), result.pairs.end(),
            [](const AlignedPair& a, const AlignedPair& b) { return a.query < b.query; });
  result.pair_classes = static_cast<int>(classes.size());
  result.spread_m = spreadAcross(query, fit.pairs);
  result.soft_inliers = fit.soft_inliers;
  result.static_inliers = fit.static_inliers;
  result.similarity = fit.similarity;
  result.log_evidence = fit.log_evidence;
  result.log_static_evidence = fit.log_static_evidence;
  return result;
}

}  // namespace semantic_mht_slam
