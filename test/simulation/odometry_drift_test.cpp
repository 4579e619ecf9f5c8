#include "semantic_mht_slam/simulation/odometry_drift.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "semantic_mht_slam/simulation/simulator.h"

#include "scenario_files.h"

namespace semantic_mht_slam {
namespace {

/// Relative errors of the KITTI devkit over 100 to 800 m, means over every tenth frame.
struct RelativeError {
  double translation_percent = 0.0;
  double rotation_deg_per_100m = 0.0;
};

RelativeError relativeError(const std::vector<Pose>& truth, const std::vector<Pose>& estimate) {
  std::vector<double> driven = {0.0};
  for (std::size_t k = 1; k < truth.size(); ++k) {
    driven.push_back(driven.back() + (truth[k].translation_m - truth[k - 1].translation_m).norm());
  }
  RelativeError sum;
  int count = 0;
  for (std::size_t i = 0; i < truth.size(); i += 10) {
    for (int hundreds = 1; hundreds <= 8; ++hundreds) {
      const double length = 100.0 * hundreds;
      const auto end = std::lower_bound(driven.begin(), driven.end(), driven[i] + length);
      if (end == driven.end()) break;
      const std::size_t j = static_cast<std::size_t>(end - driven.begin());
      const Pose error = (estimate[i].inverse() * estimate[j]).inverse() * (truth[i].inverse() * truth[j]);
      sum.translation_percent += 100.0 * error.translation_m.norm() / length;
      sum.rotation_deg_per_100m += 100.0 * logRotation(error.rotation).norm() * 180.0 / 3.14159265358979 / length;
      ++count;
    }
  }
  return {sum.translation_percent / count, sum.rotation_deg_per_100m / count};
}

/// Mean over ten seeds of the drive of town.yaml with the odometry of a scenario.
RelativeError meanError(const std::string& odometry_of) {
  Scenario scenario = shippedScenario("town");
  scenario.odometry = shippedScenario(odometry_of).odometry;
  RelativeError mean;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const SimulatedDrive drive = simulateDrive(scenario, simulationClasses(), seed);
    const RelativeError error = relativeError(drive.T_map_base, drive.T_odom_base);
    mean.translation_percent += error.translation_percent / 10.0;
    mean.rotation_deg_per_100m += error.rotation_deg_per_100m / 10.0;
  }
  return mean;
}

SimulatedOdometryConfig withoutErrors() {
  return {0.0, 0.0, 0.0, 0.0, 50.0, 0.0, 0.0, 0.0, 0.0};
}

std::vector<Pose> circle(int frames) {
  std::vector<Pose> poses(1);
  const Pose step = {expRotation({0.0, 0.001, 0.02}), {0.8, 0.0, 0.0}};
  for (int k = 1; k < frames; ++k) poses.push_back(poses.back() * step);
  return poses;
}

// The bands are the ranges over KITTI 00, 05, 06 and 07 that the scenario files name.
TEST(OdometryDriftTest, VisualErrorsAreThoseOfOrbSlamTracking) {
  const RelativeError error = meanError("town");
  EXPECT_GT(error.translation_percent, 0.62);
  EXPECT_LT(error.translation_percent, 0.93);
  EXPECT_GT(error.rotation_deg_per_100m, 0.21);
  EXPECT_LT(error.rotation_deg_per_100m, 0.43);
}

TEST(OdometryDriftTest, LidarErrorsAreThoseOfSimple) {
  const RelativeError error = meanError("opposite_direction");
  EXPECT_GT(error.translation_percent, 0.24);
  EXPECT_LT(error.translation_percent, 0.66);
  EXPECT_GT(error.rotation_deg_per_100m, 0.09);
  EXPECT_LT(error.rotation_deg_per_100m, 0.36);
}

TEST(OdometryDriftTest, WithoutErrorsIsTheTruthFromTheFirstPoseOn) {
  const std::vector<Pose> truth = circle(500);
  const Pose T_elsewhere = {expRotation({0.1, 0.2, 0.3}), {5.0, 6.0, 7.0}};
  std::vector<Pose> moved;
  moved.reserve(truth.size());
  for (const Pose& pose : truth) moved.push_back(T_elsewhere * pose);
  const std::vector<Pose> odometry = simulateOdometry(moved, withoutErrors(), Rng(1));
  for (std::size_t k = 0; k < truth.size(); ++k) {
    EXPECT_LT((odometry[k].translation_m - truth[k].translation_m).norm(), 1e-9);
    EXPECT_LT(angularDistance(odometry[k].rotation, truth[k].rotation), 1e-9);
  }
}

TEST(OdometryDriftTest, AStandingVehicleDoesNotDrift) {
  const std::vector<Pose> odometry = simulateOdometry(std::vector<Pose>(100), {}, Rng(1));
  EXPECT_EQ(odometry.back().translation_m, Eigen::Vector3d::Zero());
  EXPECT_LT(angularDistance(odometry.back().rotation, Eigen::Quaterniond::Identity()), 1e-12);
}

TEST(OdometryDriftTest, HeadingErrorGrowsWithTheRootOfTheDistance) {
  SimulatedOdometryConfig config = withoutErrors();
  config.heading_noise_rad_per_sqrt_m = 0.001;
  double squares = 0.0;
  const int runs = 400;
  const std::vector<Pose> truth = circle(501);  // 400 m
  for (std::uint64_t seed = 0; seed < runs; ++seed) {
    const Pose last = simulateOdometry(truth, config, Rng(seed)).back();
    const double error = angularDistance(last.rotation, truth.back().rotation);
    squares += error * error / runs;
  }
  EXPECT_NEAR(std::sqrt(squares), 0.02, 0.003);
}

TEST(OdometryDriftTest, ABiasMakesErrorsOfNeighbouringStepsAlike) {
  SimulatedOdometryConfig config = withoutErrors();
  config.heading_bias_rad_per_m = 0.001;
  const std::vector<Pose> truth = circle(4000);
  const std::vector<Pose> odometry = simulateOdometry(truth, config, Rng(3));
  std::vector<double> errors;
  for (std::size_t k = 1; k < truth.size(); ++k) {
    const Pose step = (truth[k - 1].inverse() * truth[k]).inverse() * (odometry[k - 1].inverse() * odometry[k]);
    errors.push_back(logRotation(step.rotation).z());
  }
  double products = 0.0;
  double squares = 0.0;
  for (std::size_t k = 1; k < errors.size(); ++k) {
    products += errors[k] * errors[k - 1];
    squares += errors[k] * errors[k];
  }
  EXPECT_NEAR(products / squares, std::exp(-0.8 / config.bias_length_m), 0.01);
}

}  // namespace
}  // namespace semantic_mht_slam
