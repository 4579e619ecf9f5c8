#include "pose_refinement.h"

#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace semantic_mht_slam {
namespace {

constexpr int kIterations = 5;

Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d result;
  result << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return result;
}

}  // namespace

RefinedPose refinePose(const Pose& T_a_b, const std::vector<PointPair>& pairs, double tilt_stddev_rad,
                       double huber_sigma, double floor_m2) {
  const double tilt_information = 1.0 / (tilt_stddev_rad * tilt_stddev_rad);
  RefinedPose refined{T_a_b, PoseCov::Identity()};
  PoseCov H;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    const Eigen::Matrix3d R = refined.T_a_b.rotation.toRotationMatrix();
    const Eigen::Vector3d turned = logRotation(T_a_b.rotation.conjugate() * refined.T_a_b.rotation);
    H.setZero();
    Eigen::Matrix<double, 6, 1> g = Eigen::Matrix<double, 6, 1>::Zero();
    for (int axis = 0; axis < 2; ++axis) {
      H(3 + axis, 3 + axis) += tilt_information;
      g[3 + axis] -= tilt_information * turned[axis];
    }
    for (const PointPair& pair : pairs) {
      const Eigen::Vector3d residual = pair.in_a_m - refined.T_a_b * pair.in_b_m;
      Eigen::Matrix<double, 3, 6> J;
      J << R, -R * skew(pair.in_b_m);
      const Eigen::Matrix3d information = pair.cov_m2.inverse();
      const double deviation = std::sqrt(std::max(0.0, residual.dot(information * residual)));
      const double weight = deviation > huber_sigma ? huber_sigma / deviation : 1.0;
      H += weight * J.transpose() * information * J;
      g += weight * J.transpose() * information * residual;
    }
    const Eigen::LDLT<PoseCov> solver(H);
    const Eigen::Matrix<double, 6, 1> step = solver.solve(g);
    if (solver.info() != Eigen::Success || !step.allFinite()) return {T_a_b, PoseCov::Identity()};
    refined.T_a_b.translation_m += R * step.head<3>();
    refined.T_a_b.rotation = (refined.T_a_b.rotation * expRotation(step.tail<3>())).normalized();
  }
  const PoseCov cov = H.inverse();
  refined.cov = 0.5 * (cov + cov.transpose());
  refined.cov.diagonal().head<3>().array() += floor_m2;
  return refined;
}

}  // namespace semantic_mht_slam
