#include "semantic_mht_slam/mapping/pose_offset.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace semantic_mht_slam {
namespace {

using Jacobian = Eigen::Matrix<double, 3, 4>;

/// Motion of a point at `lever_m` with the offset.
Jacobian jacobian(const Eigen::Vector3d& lever_m) {
  Jacobian J = Jacobian::Zero();
  J.leftCols<3>().setIdentity();
  J.col(3) << -lever_m.y(), lever_m.x(), 0.0;
  return J;
}

}  // namespace

Pose corrected(const Pose& T_submap_base, const PoseOffset& offset) {
  return {(expRotation({0.0, 0.0, offset.mean[3]}) * T_submap_base.rotation).normalized(),
          T_submap_base.translation_m + offset.mean.head<3>()};
}

Eigen::Matrix<double, 6, 6> stepCov(const PoseOffset& offset, double tilt_stddev_rad) {
  // The base is level, so that its z axis is the one that the heading turns about.
  const Eigen::Matrix3d R_base_map = expRotation({0.0, 0.0, -offset.mean[3]}).toRotationMatrix();
  Eigen::Matrix<double, 6, 4> J = Eigen::Matrix<double, 6, 4>::Zero();
  J.topLeftCorner<3, 3>() = R_base_map;
  J(5, 3) = 1.0;
  Eigen::Matrix<double, 6, 6> cov = symmetric(J * offset.cov * J.transpose());
  cov(3, 3) += tilt_stddev_rad * tilt_stddev_rad;
  cov(4, 4) += tilt_stddev_rad * tilt_stddev_rad;
  return cov;
}

Eigen::Matrix3d pointCov(const PoseOffset& offset, const Eigen::Vector3d& lever_m) {
  // J cov J^T by the blocks of J = [I, turn]: this is done for every detection in every hypothesis.
  const Eigen::Vector3d turn(-lever_m.y(), lever_m.x(), 0.0);
  const Eigen::Matrix3d cross = offset.cov.topRightCorner<3, 1>() * turn.transpose();
  return offset.cov.topLeftCorner<3, 3>() + cross + cross.transpose() + offset.cov(3, 3) * turn * turn.transpose();
}

PoseOffset grown(const PoseOffset& offset, const Pose& T_submap_last, const Pose& T_submap_base,
                 const OdometryModel& odometry) {
  const Pose step = T_submap_last.inverse() * T_submap_base;
  const Pose expected = expectedStep(odometry, step);
  const Eigen::Matrix3d turn = expRotation({0.0, 0.0, offset.mean[3]}).toRotationMatrix();
  const Eigen::Matrix3d R = turn * T_submap_last.rotation.toRotationMatrix();
  const Eigen::Vector3d driven_m = R * expected.translation_m;
  PoseOffset result = offset;
  result.mean.head<3>() += driven_m - (T_submap_base.translation_m - T_submap_last.translation_m);
  result.mean[3] += headingOf(step.rotation.conjugate() * expected.rotation);
  Eigen::Matrix4d F = Eigen::Matrix4d::Identity();
  F.col(3).head<2>() << -driven_m.y(), driven_m.x();
  result.cov = F * offset.cov * F.transpose();
  const MotionVariance noise = varianceOf(odometry, motionOf(step));
  const Eigen::Vector3d along = driven_m.squaredNorm() > 0.0 ? Eigen::Vector3d(driven_m.normalized()) : R.col(0);
  Eigen::Matrix2d cov_m2 = noise.across_m2 * Eigen::Matrix2d::Identity();
  cov_m2 += (noise.along_m2 - noise.across_m2) * along.head<2>() * along.head<2>().transpose();
  result.cov.topLeftCorner<2, 2>() += cov_m2;
  result.cov(2, 2) += noise.up_m2;
  result.cov(3, 3) += noise.heading_rad2;
  return result;
}

PoseOffset updated(const PoseOffset& offset, const std::vector<OffsetObservation>& observations, double huber_sigma) {
  if (observations.empty()) return offset;
  // A little is added so that a known offset (covariance 0) has an inverse.
  const Eigen::Matrix4d prior = offset.cov + 1e-9 * Eigen::Matrix4d::Identity();
  Eigen::Matrix4d information = prior.inverse();
  Eigen::Vector4d vector = Eigen::Vector4d::Zero();
  for (const OffsetObservation& observation : observations) {
    const Jacobian J = jacobian(observation.lever_m);
    const Eigen::Matrix3d expected = observation.cov_m2 + J * prior * J.transpose();
    const double deviations = std::sqrt(observation.residual_m.dot(expected.llt().solve(observation.residual_m)));
    const double weight = deviations > huber_sigma ? huber_sigma / deviations : 1.0;
    const Eigen::Matrix<double, 4, 3> gain = weight * J.transpose() * observation.cov_m2.inverse();
    information += gain * J;
    vector += gain * observation.residual_m;
  }
  PoseOffset result;
  result.cov = information.inverse();
  const Eigen::Vector4d step = result.cov * vector;
  result.mean = offset.mean + step;
  result.cov = symmetric(result.cov);
  return result.mean.allFinite() && result.cov.allFinite() ? result : offset;
}

}  // namespace semantic_mht_slam
