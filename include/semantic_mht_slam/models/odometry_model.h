#pragma once

#include <Eigen/Core>

#include "semantic_mht_slam/common/config.h"
#include "semantic_mht_slam/common/pose.h"

namespace semantic_mht_slam {

class StateArchive;

/// Standard deviations of the odometry's errors, which grow with the square root of the way and of the turn: the
/// odometry motion model (Thrun, Burgard, Fox, Probabilistic Robotics, 2005, section 5.4) with variances that add up,
/// so that they do not depend on how often the odometry comes. The defaults are wide enough for any robot.
struct OdometryNoise {
  double along_m_per_sqrt_m = 0.08;
  double across_m_per_sqrt_m = 0.05;
  double up_m_per_sqrt_m = 0.03;
  double heading_rad_per_sqrt_m = 0.0015;
  double heading_rad_per_sqrt_rad = 0.02;
  double tilt_rad_per_sqrt_m = 0.0007;
};

void describe(OdometryNoise& noise, Fields& fields);

/// A coefficient of the systematic errors.
struct CoefficientEstimate {
  double mean = 0.0;
  double stddev = 0.0;
};

/// Errors that every step has alike, true step less odometry's: wheels of other sizes than was thought, a base frame
/// that is turned or stands beside the axle (Borenstein, Feng, Measurement and correction of systematic odometry errors
/// in mobile robots, 1996).
struct SystematicErrors {
  CoefficientEstimate scale_translation;  ///< along, m/m
  CoefficientEstimate scale_turn;         ///< heading, rad/rad
  CoefficientEstimate heading_rad_per_m;  ///< of a straight way that the odometry takes for a bend
  CoefficientEstimate direction_m_per_m;  ///< across the way
  CoefficientEstimate lever_m_per_rad;    ///< across, by turning
};

/// What is known of an odometry.
struct OdometryModel {
  OdometryNoise noise;
  SystematicErrors systematic;
};

void transfer(StateArchive& archive, OdometryModel& model);

/// How much a vehicle moved, all steps added up.
struct Motion {
  double way_m = 0.0;
  double turn_rad = 0.0;  ///< of the heading, whichever way
};

Motion operator+(const Motion& a, const Motion& b);
Motion operator-(const Motion& a, const Motion& b);
void transfer(StateArchive& archive, Motion& motion);

/// Of one step of the odometry.
Motion motionOf(const Pose& T_a_b);

/// Heading of a rotation about z, rad.
double headingOf(const Eigen::Quaterniond& rotation);

/// Variances of the odometry's error over a stretch, as if each error came at its end.
struct MotionVariance {
  double along_m2 = 0.0;
  double across_m2 = 0.0;
  double up_m2 = 0.0;
  double heading_rad2 = 0.0;
  double tilt_rad2 = 0.0;  ///< of roll and of pitch
};

MotionVariance varianceOf(const OdometryNoise& noise, const Motion& motion);

/// The same with what is not known of the systematic errors, as if these were others for every radian and every few
/// metres.
MotionVariance varianceOf(const OdometryModel& model, const Motion& motion);

/// Covariance of a step T_a_b: translation, then rotation, in the axes of b, with what an error of the heading on the
/// way does to the position at its end.
Eigen::Matrix<double, 6, 6> stepCovariance(const OdometryModel& model, const Motion& motion, const Pose& T_a_b);

/// The step as it is expected to have been, systematic errors taken off.
Pose expectedStep(const OdometryModel& model, const Pose& T_a_b);

}  // namespace semantic_mht_slam
