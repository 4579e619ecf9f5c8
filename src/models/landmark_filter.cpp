#include "semantic_mht_slam/models/landmark_filter.h"

#include <array>
#include <cmath>

#include <Eigen/Cholesky>

namespace semantic_mht_slam {
namespace {

constexpr int kDimension = 3;
// kappa = 3 - n = 0 for n = 3 matches the fourth moment of a Gaussian: the centre point has weight 0, and is left out
constexpr int kPoints = 2 * kDimension;
constexpr double kSpread = 3.0;
constexpr double kWeight = 1.0 / (2.0 * kSpread);

using SigmaPoints = std::array<Eigen::Vector3d, kPoints>;

double wrapped(double angle_rad) {
  return std::abs(angle_rad) <= M_PI ? angle_rad : std::remainder(angle_rad, 2.0 * M_PI);
}

std::optional<SigmaPoints> sigmaPoints(const Gaussian3& gaussian) {
  const Eigen::LLT<Eigen::Matrix3d> factor(gaussian.cov_m2);
  if (factor.info() != Eigen::Success) return std::nullopt;
  const Eigen::Matrix3d offsets = std::sqrt(kSpread) * Eigen::Matrix3d(factor.matrixL());
  SigmaPoints points;
  for (int i = 0; i < kDimension; ++i) {
    points[static_cast<std::size_t>(i)] = gaussian.mean_m + offsets.col(i);
    points[kDimension + static_cast<std::size_t>(i)] = gaussian.mean_m - offsets.col(i);
  }
  return points;
}

/// The update that is common to all measurement models. `predict(point)` is the measurement of a point,
/// `difference(a, b)` the measurement-space difference a - b.
template <class Predict, class Difference>
std::optional<FilterUpdate> update(const Gaussian3& prior, const Eigen::Vector3d& measured,
                                   const Eigen::Matrix3d& noise, const Predict& predict, const Difference& difference) {
  const std::optional<SigmaPoints> points = sigmaPoints(prior);
  if (!points) return std::nullopt;
  const Eigen::Vector3d reference = predict(prior.mean_m);
  SigmaPoints offsets;  // predicted measurements relative to the reference, where differences of angles are small
  Eigen::Vector3d mean_offset = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < kPoints; ++k) {
    offsets[k] = difference(predict((*points)[k]), reference);
    mean_offset += kWeight * offsets[k];
  }
  Eigen::Matrix3d innovation_cov = noise;
  Eigen::Matrix3d cross_cov = Eigen::Matrix3d::Zero();
  for (std::size_t k = 0; k < kPoints; ++k) {
    const Eigen::Vector3d d = offsets[k] - mean_offset;
    innovation_cov += kWeight * d * d.transpose();
    cross_cov += kWeight * ((*points)[k] - prior.mean_m) * d.transpose();
  }
  const Eigen::Vector3d innovation = difference(measured, reference) - mean_offset;
  const auto evaluation = evaluate({Eigen::Vector3d::Zero(), innovation_cov}, innovation);
  if (!evaluation) return std::nullopt;
  const Eigen::LLT<Eigen::Matrix3d> factor(innovation_cov);
  const Eigen::Matrix3d gain = factor.solve(cross_cov.transpose()).transpose();
  FilterUpdate result;
  result.posterior.mean_m = prior.mean_m + gain * innovation;
  const Eigen::Matrix3d cov = prior.cov_m2 - gain * innovation_cov * gain.transpose();
  result.posterior.cov_m2 = 0.5 * (cov + cov.transpose());
  result.log_likelihood = evaluation->log_density;
  result.mahalanobis_sq = evaluation->mahalanobis_sq;
  return result;
}

}  // namespace

Eigen::Vector3d toRangeBearingElevation(const Eigen::Vector3d& point_m) {
  const double planar = std::hypot(point_m.x(), point_m.y());
  return {point_m.norm(), std::atan2(point_m.y(), point_m.x()), std::atan2(point_m.z(), planar)};
}

std::optional<FilterUpdate> unscentedUpdate(const Gaussian3& prior, const PositionMeasurement& measurement) {
  return update(
      prior, measurement.position_m, measurement.cov_m2, [](const Eigen::Vector3d& point) { return point; },
      [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) -> Eigen::Vector3d { return a - b; });
}

std::optional<FilterUpdate> unscentedUpdate(const Gaussian3& prior, const RangeBearingMeasurement& measurement) {
  const Pose T_sensor_landmarks = measurement.T_landmarks_sensor.inverse();
  // The sensor's position is uncertain: seen from the sensor, so is the landmark, by as much.
  const Gaussian3 relative{prior.mean_m, prior.cov_m2 + measurement.sensor_position_cov_m2};
  const Eigen::Matrix3d noise = measurement.stddev.cwiseAbs2().asDiagonal();
  const auto predict = [&](const Eigen::Vector3d& point) -> Eigen::Vector3d {
    return toRangeBearingElevation(T_sensor_landmarks * point);
  };
  const auto difference = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) -> Eigen::Vector3d {
    return {a.x() - b.x(), wrapped(a.y() - b.y()), wrapped(a.z() - b.z())};
  };
  auto result = update(relative, measurement.range_bearing_elevation, noise, predict, difference);
  if (!result || measurement.sensor_position_cov_m2.isZero(0.0)) return result;
  // Fused as one position: what the measurement says of (landmark - sensor) goes to the landmark in the share of its
  // own uncertainty, the Kalman gain of a sum of two independent Gaussians.
  const Eigen::Matrix3d gain = relative.cov_m2.llt().solve(prior.cov_m2).transpose();
  result->posterior.mean_m = prior.mean_m + gain * (result->posterior.mean_m - prior.mean_m);
  const Eigen::Matrix3d cov = prior.cov_m2 - gain * (relative.cov_m2 - result->posterior.cov_m2) * gain.transpose();
  result->posterior.cov_m2 = 0.5 * (cov + cov.transpose());
  return result;
}

}  // namespace semantic_mht_slam
