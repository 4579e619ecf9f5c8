#pragma once

#include <optional>

#include <Eigen/Core>

#include "semantic_mht_slam/common/gaussian.h"
#include "semantic_mht_slam/common/pose.h"

namespace semantic_mht_slam {

/// Additive position measurement (paper, section II): z = pi + noise, noise ~ N(0, `cov_m2`), both in the frame of the
/// landmark, metres.
struct PositionMeasurement {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d cov_m2 = Eigen::Matrix3d::Identity();
};

/// Range, bearing and elevation of a landmark seen from a sensor whose pose is known with an uncertainty.
struct RangeBearingMeasurement {
  Pose T_landmarks_sensor;                                           ///< sensor in the frame of the landmark
  Eigen::Vector3d range_bearing_elevation{1.0, 0.0, 0.0};            ///< m, rad, rad
  Eigen::Vector3d stddev{0.1, 0.01, 0.01};                           ///< m, rad, rad
  Eigen::Matrix3d sensor_position_cov_m2 = Eigen::Matrix3d::Zero();  ///< of the sensor's position, landmark frame
};

/// What a measurement did to a landmark.
struct FilterUpdate {
  Gaussian3 posterior;
  double log_likelihood = 0.0;  ///< of the innovation; 1/m^3 or 1/(m rad^2)
  double mahalanobis_sq = 0.0;  ///< of the innovation, 3 degrees of freedom
};

/// Unscented Kalman update (Julier and Uhlmann; Wan and van der Merwe 2000) with 2n + 1 symmetric sigma points, weights
/// kappa = 3 - n. For the additive model it is the Kalman update. Empty if a covariance is not positive definite.
std::optional<FilterUpdate> unscentedUpdate(const Gaussian3& prior, const PositionMeasurement& measurement);
std::optional<FilterUpdate> unscentedUpdate(const Gaussian3& prior, const RangeBearingMeasurement& measurement);

/// Range, bearing (about z, from x to y) and elevation of a point in the sensor frame. A point at the sensor has range
/// 0.
Eigen::Vector3d toRangeBearingElevation(const Eigen::Vector3d& point_m);

}  // namespace semantic_mht_slam
