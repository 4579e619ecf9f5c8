#include "semantic_mht_slam/models/odometry_model.h"

#include <cmath>

#include <Eigen/Geometry>

#include "semantic_mht_slam/common/state_archive.h"

namespace semantic_mht_slam {
namespace {

constexpr double kAlike_m = 3.0;  // over which systematic errors that are not known act as one
constexpr double kAlike_rad = 1.0;
constexpr double kLongest = 1e11;  // way and turn, as far as poses may lie
constexpr double kLargest = 1e30;  // whose products with a way and with themselves are numbers

double squared(double value) {
  return value * value;
}

void transfer(StateArchive& archive, CoefficientEstimate& estimate) {
  auto& [mean, stddev] = estimate;
  archive(mean, stddev);
  archive.require(std::abs(mean) <= kLargest && stddev >= 0.0 && stddev <= kLargest,
                  "an error of the odometry that is none");
}

}  // namespace

void transfer(StateArchive& archive, OdometryModel& model) {
  auto& [along, across, up, heading_by_way, heading_by_turn, tilt] = model.noise;
  for (double* stddev : {&along, &across, &up, &heading_by_way, &heading_by_turn, &tilt}) {
    archive(*stddev);
    archive.require(*stddev >= 0.0 && *stddev <= kLargest, "a deviation of the odometry that is none");
  }
  auto& [scale_translation, scale_turn, heading_rad_per_m, direction_m_per_m, lever_m_per_rad] = model.systematic;
  for (CoefficientEstimate* estimate :
       {&scale_translation, &scale_turn, &heading_rad_per_m, &direction_m_per_m, &lever_m_per_rad}) {
    transfer(archive, *estimate);
  }
}

void describe(OdometryNoise& noise, Fields& fields) {
  fields.add("along", noise.along_m_per_sqrt_m, "m/sqrt(m)", {1e-5, 10.0},
             "Growth of the position error along the way with the square root of the way.");
  fields.add("across", noise.across_m_per_sqrt_m, "m/sqrt(m)", {1e-5, 10.0}, "The same across the way.");
  fields.add("up", noise.up_m_per_sqrt_m, "m/sqrt(m)", {1e-5, 10.0}, "The same of the height.");
  fields.add("heading", noise.heading_rad_per_sqrt_m, "rad/sqrt(m)", {1e-7, 1.0},
             "Growth of the heading error with the square root of the way,");
  fields.add("heading_per_turn", noise.heading_rad_per_sqrt_rad, "rad/sqrt(rad)", {1e-6, 1.0},
             "and with the square root of what was turned.");
  fields.add("tilt", noise.tilt_rad_per_sqrt_m, "rad/sqrt(m)", {1e-7, 1.0},
             "Growth of the error of roll and pitch with the square root of the way.");
}

Motion operator+(const Motion& a, const Motion& b) {
  return {a.way_m + b.way_m, a.turn_rad + b.turn_rad};
}

Motion operator-(const Motion& a, const Motion& b) {
  return {a.way_m - b.way_m, a.turn_rad - b.turn_rad};
}

void transfer(StateArchive& archive, Motion& motion) {
  archive(motion.way_m, motion.turn_rad);
  const bool is_way =
      motion.way_m >= 0.0 && motion.way_m <= kLongest && motion.turn_rad >= 0.0 && motion.turn_rad <= kLongest;
  archive.require(is_way, "a way that is negative, or longer than any");
}

double headingOf(const Eigen::Quaterniond& rotation) {
  const Eigen::Matrix3d R = rotation.toRotationMatrix();
  return std::atan2(R(1, 0), R(0, 0));
}

Motion motionOf(const Pose& T_a_b) {
  return {T_a_b.translation_m.norm(), std::abs(headingOf(T_a_b.rotation))};
}

MotionVariance varianceOf(const OdometryNoise& noise, const Motion& motion) {
  MotionVariance variance;
  variance.along_m2 = squared(noise.along_m_per_sqrt_m) * motion.way_m;
  variance.across_m2 = squared(noise.across_m_per_sqrt_m) * motion.way_m;
  variance.up_m2 = squared(noise.up_m_per_sqrt_m) * motion.way_m;
  variance.heading_rad2 =
      squared(noise.heading_rad_per_sqrt_m) * motion.way_m + squared(noise.heading_rad_per_sqrt_rad) * motion.turn_rad;
  variance.tilt_rad2 = squared(noise.tilt_rad_per_sqrt_m) * motion.way_m;
  return variance;
}

MotionVariance varianceOf(const OdometryModel& model, const Motion& motion) {
  const SystematicErrors& unknown = model.systematic;
  const double metres_m2 = motion.way_m * kAlike_m;
  const double radians_rad2 = motion.turn_rad * kAlike_rad;
  MotionVariance variance = varianceOf(model.noise, motion);
  variance.along_m2 += squared(unknown.scale_translation.stddev) * metres_m2;
  variance.across_m2 +=
      squared(unknown.direction_m_per_m.stddev) * metres_m2 + squared(unknown.lever_m_per_rad.stddev) * radians_rad2;
  variance.heading_rad2 +=
      squared(unknown.scale_turn.stddev) * radians_rad2 + squared(unknown.heading_rad_per_m.stddev) * metres_m2;
  return variance;
}

Eigen::Matrix<double, 6, 6> stepCovariance(const OdometryModel& model, const Motion& motion, const Pose& T_a_b) {
  const MotionVariance variance = varianceOf(model, motion);
  Eigen::Matrix<double, 6, 6> cov = Eigen::Matrix<double, 6, 6>::Zero();
  cov.diagonal().head<3>() << variance.along_m2, variance.across_m2, variance.up_m2;
  const Eigen::Vector3d rotation_rad2(variance.tilt_rad2, variance.tilt_rad2, variance.heading_rad2);
  cov.diagonal().tail<3>() = rotation_rad2;
  // Errors of the rotation come evenly along the way: the mean lever is half of it, its square a third.
  const Eigen::Vector3d way_m = T_a_b.rotation.conjugate() * T_a_b.translation_m;
  Eigen::Matrix3d lever;
  lever << 0.0, way_m.z(), -way_m.y(), -way_m.z(), 0.0, way_m.x(), way_m.y(), -way_m.x(), 0.0;
  cov.topLeftCorner<3, 3>() += lever * rotation_rad2.asDiagonal() * lever.transpose() / 3.0;
  cov.topRightCorner<3, 3>() = 0.5 * lever * rotation_rad2.asDiagonal();
  cov.bottomLeftCorner<3, 3>() = cov.topRightCorner<3, 3>().transpose();
  return cov;
}

Pose expectedStep(const OdometryModel& model, const Pose& T_a_b) {
  const SystematicErrors& errors = model.systematic;
  const double along_m = T_a_b.translation_m.x();
  const double turn_rad = headingOf(T_a_b.rotation);
  const double more_rad = errors.scale_turn.mean * turn_rad + errors.heading_rad_per_m.mean * along_m;
  const double across_m = errors.direction_m_per_m.mean * along_m + errors.lever_m_per_rad.mean * turn_rad;
  return {(T_a_b.rotation * expRotation({0.0, 0.0, more_rad})).normalized(),
          (1.0 + errors.scale_translation.mean) * T_a_b.translation_m + Eigen::Vector3d(0.0, across_m, 0.0)};
}

}  // namespace semantic_mht_slam
