#include "semantic_mht_slam/models/landmark_filter.h"

#include <cmath>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "semantic_mht_slam/common/random.h"

namespace semantic_mht_slam {
namespace {

Eigen::Matrix3d randomCov(Rng& rng, double scale) {
  Eigen::Matrix3d a;
  for (int i = 0; i < 9; ++i) a(i) = rng.normal();
  return scale * (a * a.transpose() + 0.2 * Eigen::Matrix3d::Identity());
}

Eigen::Vector3d sample(Rng& rng, const Eigen::Matrix3d& cov) {
  return Eigen::Matrix3d(cov.llt().matrixL()) * Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal());
}

TEST(LandmarkFilterTest, UnscentedUpdateOfTheLinearModelIsTheKalmanUpdate) {
  Rng rng(1);
  for (int i = 0; i < 100; ++i) {
    const Gaussian3 prior{{rng.normal(), rng.normal(), rng.normal()}, randomCov(rng, 1.0)};
    const PositionMeasurement measurement{{rng.normal(), rng.normal(), rng.normal()}, randomCov(rng, 0.5)};
    const Eigen::Matrix3d innovation_cov = prior.cov_m2 + measurement.cov_m2;
    const Eigen::Matrix3d gain = prior.cov_m2 * innovation_cov.inverse();
    const Eigen::Vector3d innovation = measurement.position_m - prior.mean_m;
    const auto update = unscentedUpdate(prior, measurement);
    ASSERT_TRUE(update);
    EXPECT_LT((update->posterior.mean_m - (prior.mean_m + gain * innovation)).norm(), 1e-9);
    EXPECT_LT((update->posterior.cov_m2 - (prior.cov_m2 - gain * prior.cov_m2)).norm(), 1e-9);
    EXPECT_NEAR(update->mahalanobis_sq, innovation.dot(innovation_cov.inverse() * innovation), 1e-9);
    EXPECT_NEAR(update->log_likelihood, evaluate({Eigen::Vector3d::Zero(), innovation_cov}, innovation)->log_density,
                1e-9);
  }
}

/// Mean normalised estimation error squared over 100 seeds; chi-square with 300 degrees of freedom over 100: the 99.9 %
/// interval is about 3 +- 0.81.
template <class Measure>
double meanNees(const Measure& measure) {
  double sum = 0.0;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    Rng rng(seed);
    const Eigen::Vector3d truth(rng.uniform(8.0, 20.0), rng.uniform(-10.0, 10.0), rng.uniform(-1.0, 1.0));
    Gaussian3 estimate{truth, 0.25 * Eigen::Matrix3d::Identity()};
    estimate.mean_m += sample(rng, estimate.cov_m2);
    for (int i = 0; i < 20; ++i) estimate = measure(estimate, truth, rng);
    const Eigen::Vector3d error = estimate.mean_m - truth;
    sum += error.dot(estimate.cov_m2.inverse() * error);
  }
  return sum / 100.0;
}

TEST(LandmarkFilterTest, PositionEstimatesAreConsistent) {
  const double nees = meanNees([](const Gaussian3& estimate, const Eigen::Vector3d& truth, Rng& rng) {
    const Eigen::Matrix3d cov = randomCov(rng, 0.01);
    return unscentedUpdate(estimate, PositionMeasurement{truth + sample(rng, cov), cov})->posterior;
  });
  EXPECT_NEAR(nees, 3.0, 0.81);
}

TEST(LandmarkFilterTest, RangeBearingEstimatesAreConsistentWhileTheSensorMoves) {
  const double nees = meanNees([](const Gaussian3& estimate, const Eigen::Vector3d& truth, Rng& rng) {
    RangeBearingMeasurement measurement;
    measurement.T_landmarks_sensor =
        Pose{expRotation({0.0, 0.0, rng.uniform(-3.0, 3.0)}), {rng.uniform(-3.0, 3.0), rng.uniform(-3.0, 3.0), 0.0}};
    measurement.stddev = {0.1, 0.01, 0.02};
    measurement.range_bearing_elevation =
        toRangeBearingElevation(measurement.T_landmarks_sensor.inverse() * truth) +
        measurement.stddev.cwiseProduct(Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal()));
    return unscentedUpdate(estimate, measurement)->posterior;
  });
  EXPECT_NEAR(nees, 3.0, 0.81);
}

TEST(LandmarkFilterTest, BearingsAcrossTheBackOfTheSensorAreNoLargeInnovation) {
  const Gaussian3 prior{{-10.0, 0.05, 0.0}, 0.01 * Eigen::Matrix3d::Identity()};
  RangeBearingMeasurement measurement;
  measurement.range_bearing_elevation = {10.0, -M_PI + 0.005, 0.0};
  const auto update = unscentedUpdate(prior, measurement);
  ASSERT_TRUE(update);
  EXPECT_LT(update->mahalanobis_sq, 5.0);
  EXPECT_NEAR(update->posterior.mean_m.x(), -10.0, 0.1);
}

TEST(LandmarkFilterTest, AnUncertainSensorTeachesLess) {
  const Gaussian3 prior{{10.0, 0.0, 0.0}, Eigen::Matrix3d::Identity()};
  RangeBearingMeasurement measurement;
  measurement.range_bearing_elevation = {10.5, 0.02, 0.0};
  const auto certain = unscentedUpdate(prior, measurement);
  measurement.sensor_position_cov_m2 = Eigen::Matrix3d::Identity();
  const auto uncertain = unscentedUpdate(prior, measurement);
  EXPECT_LT(certain->posterior.cov_m2.trace(), uncertain->posterior.cov_m2.trace());
  EXPECT_GT(uncertain->posterior.cov_m2(0, 0), 0.45) << "two equal uncertainties share the innovation";
  EXPECT_LT(uncertain->posterior.cov_m2(0, 0), 0.56);
}

TEST(LandmarkFilterTest, SingularPriorsAreRefused) {
  EXPECT_FALSE(unscentedUpdate({Eigen::Vector3d::Zero(), Eigen::Matrix3d::Zero()}, PositionMeasurement{}));
}

}  // namespace
}  // namespace semantic_mht_slam
