#include "semantic_mht_slam/slam/drift_prior.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

namespace semantic_mht_slam {
namespace {

double squared(double value) {
  return value * value;
}

Eigen::Vector2d turned(const Eigen::Vector2d& lever_m) {
  return {-lever_m.y(), lever_m.x()};
}

/// Covariance of a pose on the plane and its height, put together step by step.
class Drift {
 public:
  explicit Drift(const OdometryModel& odometry) : odometry_(odometry) {}

  /// A step of the odometry, `lever_m` before the pose that is asked for, `driven_m` and turned by `turn_rad`.
  void add(const Motion& motion, const Eigen::Vector2d& driven_m, double turn_rad, const Eigen::Vector2d& lever_m) {
    const MotionVariance variance = varianceOf(odometry_.noise, motion);
    const Eigen::Vector2d swing_m = turned(lever_m);
    cov_m2_ += std::max(variance.along_m2, variance.across_m2) * Eigen::Matrix2d::Identity();
    cov_m2_ += variance.heading_rad2 * swing_m * swing_m.transpose();
    heading_rad2_ += variance.heading_rad2;
    up_m2_ += variance.up_m2 + variance.tilt_rad2 * lever_m.squaredNorm();
    by_scale_m_ += driven_m;
    by_turn_m_ += turn_rad * swing_m;
    by_bend_m_ += motion.way_m * swing_m;
    by_direction_m_ += turned(driven_m);
    turn_rad_ += turn_rad;
    way_m_ += motion.way_m;
  }

  void writeTo(RegistrationPrior& prior, const RevisitConfig& config, double told_stddev_m) const {
    const SystematicErrors& unknown = odometry_.systematic;
    Eigen::Matrix2d cov_m2 = cov_m2_;
    const auto addSystematic = [&](const CoefficientEstimate& error, const Eigen::Vector2d& effect_m) {
      cov_m2 += squared(error.stddev) * effect_m * effect_m.transpose();
    };
    addSystematic(unknown.scale_translation, by_scale_m_);
    addSystematic(unknown.scale_turn, by_turn_m_);
    addSystematic(unknown.heading_rad_per_m, by_bend_m_);
    addSystematic(unknown.direction_m_per_m, by_direction_m_);
    const double heading_rad2 = heading_rad2_ + squared(unknown.scale_turn.stddev * turn_rad_) +
                                squared(unknown.heading_rad_per_m.stddev * way_m_);
    const double largest_m2 =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(cov_m2, Eigen::EigenvaluesOnly).eigenvalues().maxCoeff();
    const double base_m2 = squared(config.base_stddev_m) + squared(told_stddev_m);
    prior.stddev_xy_m = std::min<double>(config.max_stddev_m, std::sqrt(base_m2 + std::max(0.0, largest_m2)));
    prior.stddev_z_m = std::min<double>(config.max_stddev_m, std::sqrt(base_m2 + up_m2_));
    prior.stddev_yaw_rad = std::sqrt(squared(config.base_stddev_rad) + heading_rad2);
  }

 private:
  const OdometryModel& odometry_;
  Eigen::Matrix2d cov_m2_ = Eigen::Matrix2d::Zero();
  double heading_rad2_ = 0.0;
  double up_m2_ = 0.0;
  Eigen::Vector2d by_scale_m_ = Eigen::Vector2d::Zero();  ///< what each systematic error of 1 has done to the position
  Eigen::Vector2d by_turn_m_ = Eigen::Vector2d::Zero();
  Eigen::Vector2d by_bend_m_ = Eigen::Vector2d::Zero();
  Eigen::Vector2d by_direction_m_ = Eigen::Vector2d::Zero();
  double turn_rad_ = 0.0;
  double way_m_ = 0.0;
};

}  // namespace

RegistrationPrior driftPrior(const Map& map, double tied_at_m, const Pose& T_map_base, const Motion& more,
                             const OdometryModel& odometry, const RevisitConfig& config) {
  RegistrationPrior prior;
  prior.T_a_b = T_map_base;
  Drift drift(odometry);
  for (std::size_t k = map.keyframes().size(); k-- > 1;) {
    const KeyframeId to(k);
    const KeyframeId from(k - 1);
    if (map.keyframes()[from].driven_m < tied_at_m) break;
    const Motion motion = motionTo(map.keyframes()[to]) - motionTo(map.keyframes()[from]);
    const Pose& T_from = map.T_map_keyframe(from);
    const Pose& T_to = map.T_map_keyframe(to);
    drift.add(motion, (T_to.translation_m - T_from.translation_m).head<2>(),
              headingOf(T_from.rotation.conjugate() * T_to.rotation),
              (T_map_base.translation_m - T_to.translation_m).head<2>());
  }
  drift.add(more, Eigen::Vector2d(more.way_m, 0.0), more.turn_rad, Eigen::Vector2d(0.5 * more.way_m, 0.0));
  drift.writeTo(prior, config, 0.0);
  return prior;
}

RegistrationPrior driftPrior(const Pose& T_map_base, double told_stddev_m, const Motion& motion,
                             const OdometryModel& odometry, const RevisitConfig& config) {
  RegistrationPrior prior;
  prior.T_a_b = T_map_base;
  Drift drift(odometry);
  drift.add(motion, Eigen::Vector2d(motion.way_m, 0.0), motion.turn_rad, Eigen::Vector2d(0.5 * motion.way_m, 0.0));
  drift.writeTo(prior, config, told_stddev_m);
  return prior;
}

}  // namespace semantic_mht_slam
