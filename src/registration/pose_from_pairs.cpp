#include "pose_from_pairs.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "semantic_mht_slam/common/gaussian.h"

namespace semantic_mht_slam {
namespace {

constexpr int kMaxIterations = 5;
constexpr double kConverged = 1e-6;  // m and rad
constexpr double kHuberSigma = 2.0;

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// Normal equations of a step on the right.
struct NormalEquations {
  Matrix6 information = Matrix6::Zero();
  Vector6 gradient = Vector6::Zero();
};

NormalEquations normalEquations(const Pose& T_a_b, const std::vector<PointPair>& pairs) {
  NormalEquations sums;
  const Eigen::Matrix3d R = T_a_b.rotation.toRotationMatrix();
  for (const PointPair& pair : pairs) {
    const Eigen::Vector3d residual_m = pair.in_a_m - T_a_b * pair.in_b_m;
    Eigen::Matrix<double, 3, 6> J;
    J << R, -R * skew(pair.in_b_m);
    const Eigen::Matrix3d information = pair.cov_m2.inverse();
    const double sigmas = std::sqrt(std::max(0.0, residual_m.dot(information * residual_m)));
    const double weight = pair.weight * (sigmas > kHuberSigma ? kHuberSigma / sigmas : 1.0);
    sums.information += weight * J.transpose() * information * J;
    sums.gradient += weight * J.transpose() * information * residual_m;
  }
  return sums;
}

/// What a mean over the points of a keeps if their errors are fully correlated.
Eigen::Matrix3d commonCov(const std::vector<PointPair>& pairs) {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  for (const PointPair& pair : pairs) information += pair.a_cov_m2.inverse();
  return static_cast<double>(pairs.size()) * information.inverse();
}

}  // namespace

std::optional<PoseEstimate> poseFromPairs(const Pose& T_a_b, const std::vector<PointPair>& pairs,
                                          double tilt_stddev_rad) {
  const double tilt_information = 1.0 / (tilt_stddev_rad * tilt_stddev_rad);
  PoseEstimate estimate{T_a_b, Matrix6::Identity()};
  Eigen::LDLT<Matrix6> solver;
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    NormalEquations sums = normalEquations(estimate.T_a_b, pairs);
    const Eigen::Vector3d turned = logRotation(T_a_b.rotation.conjugate() * estimate.T_a_b.rotation);
    for (int axis = 0; axis < 2; ++axis) {
      sums.information(3 + axis, 3 + axis) += tilt_information;
      sums.gradient(3 + axis) -= tilt_information * turned(axis);
    }
    solver.compute(sums.information);
    if (solver.info() != Eigen::Success || !solver.isPositive() || solver.rcond() < 1e-12) return std::nullopt;
    const Vector6 step = solver.solve(sums.gradient);
    estimate.T_a_b.translation_m += estimate.T_a_b.rotation * step.head<3>();
    estimate.T_a_b.rotation = (estimate.T_a_b.rotation * expRotation(step.tail<3>())).normalized();
    if (step.norm() < kConverged) break;
  }
  estimate.cov = symmetric(solver.solve(Matrix6::Identity()));
  const Eigen::Matrix3d R_b_a = estimate.T_a_b.rotation.toRotationMatrix().transpose();
  estimate.cov.topLeftCorner<3, 3>() += symmetric(R_b_a * commonCov(pairs) * R_b_a.transpose());
  if (!estimate.T_a_b.isValid() || !estimate.cov.allFinite()) return std::nullopt;
  return estimate;
}

}  // namespace semantic_mht_slam
