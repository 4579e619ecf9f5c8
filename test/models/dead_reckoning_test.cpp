#include "semantic_mht_slam/models/dead_reckoning.h"

#include <cmath>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "semantic_mht_slam/common/random.h"

namespace semantic_mht_slam {
namespace {

OdometryModel modelOf(double scale_mean, double scale_stddev) {
  OdometryModel model;
  model.systematic.scale_translation = {scale_mean, scale_stddev};
  return model;
}

UncertainPose driven(const OdometryModel& model, int steps, double step_m, double turn_rad = 0.0) {
  UncertainPose pose;
  const Pose step{expRotation({0.0, 0.0, turn_rad / steps}), {step_m, 0.0, 0.0}};
  for (int i = 0; i < steps; ++i) pose = reckoned(pose, step, model);
  return pose;
}

TEST(DeadReckoningTest, OfAStraightWayItIsWhatTheModelSays) {
  const OdometryModel model = modelOf(0.0, 0.0);
  const FixedAxesCov cov = driven(model, 100, 1.0).total();
  const OdometryNoise& noise = model.noise;
  EXPECT_NEAR(cov(0, 0), 100.0 * std::pow(noise.along_m_per_sqrt_m, 2), 1e-9);
  const double heading_rad2 = 100.0 * std::pow(noise.heading_rad_per_sqrt_m, 2);
  EXPECT_NEAR(cov(5, 5), heading_rad2, 1e-12);
  const double across_m2 = 100.0 * std::pow(noise.across_m_per_sqrt_m, 2) + heading_rad2 * 100.0 * 100.0 / 3.0;
  EXPECT_NEAR(cov(1, 1), across_m2, 1e-3 * across_m2) << "an error of the heading swings the way behind it";
}

TEST(DeadReckoningTest, ItDoesNotDependOnHowOftenTheOdometryComes) {
  const OdometryModel model = modelOf(0.0, 0.01);
  const FixedAxesCov rare = driven(model, 10, 10.0, 1.0).total();
  const FixedAxesCov often = driven(model, 1000, 0.1, 1.0).total();
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(rare(i, i), often(i, i), 0.05 * often(i, i)) << i;
}

TEST(DeadReckoningTest, SystematicErrorsActOnEveryStepAlikeWhetherKnownOrNot) {
  const double noise_m2 = driven(modelOf(0.0, 0.0), 100, 1.0).total()(0, 0);
  EXPECT_NEAR(driven(modelOf(0.0, 0.01), 100, 1.0).total()(0, 0), noise_m2 + 1.0, 1e-9);
  EXPECT_NEAR(driven(modelOf(0.01, 0.0), 100, 1.0).total()(0, 0), noise_m2 + 1.0, 1e-9);
}

TEST(DeadReckoningTest, DrivesThatErrAsTheModelSaysAreWithinTheCovariance) {
  OdometryModel model = modelOf(0.0, 0.01);
  model.systematic.heading_rad_per_m.stddev = 1e-4;
  Rng rng(7);
  const Pose step{expRotation({0.0, 0.0, 0.02}), {1.0, 0.0, 0.0}};
  const UncertainPose expected = driven(model, 100, 1.0, 2.0);
  const FixedAxesCov cov = expected.total();
  const Eigen::Matrix<double, 6, 6> root = stepCovariance({model.noise, {}}, motionOf(step), step).llt().matrixL();
  constexpr int kDrives = 400;
  double sum = 0.0;
  for (int drive = 0; drive < kDrives; ++drive) {
    const double scale = rng.normal(0.0, 0.01);
    const double bend_rad = rng.normal(0.0, 1e-4);
    Pose truth;
    for (int i = 0; i < 100; ++i) {
      Eigen::Matrix<double, 6, 1> error;
      for (int k = 0; k < 6; ++k) error[k] = rng.normal();
      error = (root * error).eval();
      error[0] += scale;
      error[5] += bend_rad;
      truth = truth * step * Pose{expRotation(error.tail<3>()), error.head<3>()};
    }
    Eigen::Matrix<double, 6, 1> e;
    e << truth.translation_m - expected.T_world_base.translation_m,
        logRotation(truth.rotation * expected.T_world_base.rotation.conjugate());
    sum += e.dot(cov.ldlt().solve(e));
  }
  EXPECT_NEAR(sum / kDrives, 6.0, 0.8);  // 400 values of deviation sqrt(12): four times .17, and what is not linear
}

TEST(DeadReckoningTest, StandingChangesNothing) {
  const OdometryModel model = modelOf(0.0, 0.01);
  const UncertainPose there = driven(model, 10, 1.0);
  UncertainPose pose = there;
  for (int i = 0; i < 100; ++i) pose = reckoned(pose, Pose::identity(), model);
  EXPECT_LT((pose.total() - there.total()).norm(), 1e-12);
}

}  // namespace
}  // namespace semantic_mht_slam
