#include "semantic_mht_slam/models/dead_reckoning.h"

#include <cmath>

#include "semantic_mht_slam/common/gaussian.h"

namespace semantic_mht_slam {

namespace {

/// What a coefficient is off by where it is taken for zero.
void takeForZero(CoefficientEstimate& error) {
  error.stddev = std::hypot(error.mean, error.stddev);
}

SystematicErrors notTakenOff(SystematicErrors errors) {
  takeForZero(errors.scale_translation);
  takeForZero(errors.scale_turn);
  takeForZero(errors.heading_rad_per_m);
  takeForZero(errors.direction_m_per_m);
  takeForZero(errors.lever_m_per_rad);
  return errors;
}

}  // namespace

SharedErrors sharedErrorsOf(const SystematicErrors& errors, const Pose& T_a_b) {
  const Eigen::Matrix3d to_b = T_a_b.rotation.conjugate().toRotationMatrix();
  const double along_m = T_a_b.translation_m.x();
  const double turn_rad = headingOf(T_a_b.rotation);
  // An error of the heading comes evenly along the way.
  const Eigen::Vector3d way_m = to_b * T_a_b.translation_m;
  const Eigen::Vector3d swing_m = 0.5 * Eigen::Vector3d::UnitZ().cross(way_m);
  SharedErrors result = SharedErrors::Zero();
  const auto turnBy = [&](int column, double error_rad) {
    result.col(column).head<3>() = error_rad * swing_m;
    result(5, column) = error_rad;
  };
  result.col(0).head<3>() = errors.scale_translation.stddev * way_m;
  turnBy(1, errors.scale_turn.stddev * turn_rad);
  turnBy(2, errors.heading_rad_per_m.stddev * along_m);
  result.col(3).head<3>() = errors.direction_m_per_m.stddev * along_m * to_b.col(1);
  result.col(4).head<3>() = errors.lever_m_per_rad.stddev * turn_rad * to_b.col(1);
  return result;
}

UncertainPose reckoned(const UncertainPose& pose, const Pose& T_base_next, const OdometryModel& odometry) {
  const OdometryModel noise_alone{odometry.noise, {}};
  UncertainPose result;
  result.T_world_base = normalized(pose.T_world_base * T_base_next);
  const Eigen::Matrix<double, 6, 6> by_swing =
      swing(result.T_world_base.translation_m - pose.T_world_base.translation_m);
  result.cov = symmetric(by_swing * pose.cov * by_swing.transpose()) +
               inFixedAxes(result.T_world_base, stepCovariance(noise_alone, motionOf(T_base_next), T_base_next));
  result.shared = by_swing * pose.shared +
                  inFixedAxes(result.T_world_base, sharedErrorsOf(notTakenOff(odometry.systematic), T_base_next));
  return result;
}

}  // namespace semantic_mht_slam
