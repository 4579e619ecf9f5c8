#include "semantic_mht_slam/mapping/pose_offset.h"

#include <cmath>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include "semantic_mht_slam/common/random.h"

namespace semantic_mht_slam {
namespace {

/// Detections of 12 landmarks around a sensor whose pose is off by `truth`, with noise.
std::vector<OffsetObservation> observe(const Eigen::Vector4d& truth, double noise_m, Rng& rng) {
  std::vector<OffsetObservation> observations;
  for (int i = 0; i < 12; ++i) {
    OffsetObservation observation;
    observation.lever_m = {rng.uniform(-20.0, 20.0), rng.uniform(-20.0, 20.0), rng.uniform(-1.0, 1.0)};
    observation.residual_m =
        truth.head<3>() + truth[3] * Eigen::Vector3d(-observation.lever_m.y(), observation.lever_m.x(), 0.0);
    for (int k = 0; k < 3; ++k) observation.residual_m[k] += rng.normal(0.0, noise_m);
    observation.cov_m2 = noise_m * noise_m * Eigen::Matrix3d::Identity();
    observations.push_back(observation);
  }
  return observations;
}

TEST(PoseOffsetTest, EstimatesAreConsistentOverSeeds) {
  double nees = 0.0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Rng rng(seed);
    PoseOffset prior;
    prior.cov = Eigen::Vector4d(0.09, 0.09, 0.04, 1e-4).asDiagonal();
    Eigen::Vector4d truth;
    for (int i = 0; i < 4; ++i) truth[i] = rng.normal(0.0, std::sqrt(prior.cov(i, i)));
    const PoseOffset posterior = updated(prior, observe(truth, 0.1, rng), 1e9);
    const Eigen::Vector4d error = posterior.mean - truth;
    nees += error.dot(posterior.cov.inverse() * error) / 200.0;
  }
  EXPECT_NEAR(nees, 4.0, 0.7);
}

TEST(PoseOffsetTest, OneWrongAssociationHardlyMovesIt) {
  Rng rng(1);
  PoseOffset prior;
  prior.cov = Eigen::Vector4d(0.09, 0.09, 0.04, 1e-4).asDiagonal();
  std::vector<OffsetObservation> observations = observe(Eigen::Vector4d::Zero(), 0.05, rng);
  observations[0].residual_m.x() += 3.0;
  const double robust_m = updated(prior, observations, 2.0).mean.head<2>().norm();
  const double plain_m = updated(prior, observations, 1e9).mean.head<2>().norm();
  EXPECT_GT(plain_m, 0.15);
  EXPECT_LT(robust_m, 0.5 * plain_m);
}

TEST(PoseOffsetTest, WithoutObservationsItOnlyGrows) {
  const PoseOffset start;
  OdometryModel odometry;
  odometry.noise.along_m_per_sqrt_m = 0.03;
  odometry.noise.across_m_per_sqrt_m = 0.02;
  odometry.noise.heading_rad_per_sqrt_m = 0.001;
  odometry.noise.heading_rad_per_sqrt_rad = 0.01;
  const Pose step{expRotation({0.0, 0.0, 0.5}), {4.0, 0.0, 0.0}};
  const PoseOffset after = grown(start, Pose::identity(), step, odometry);
  EXPECT_NEAR(after.cov(0, 0), 4.0 * 0.0009, 1e-12);
  EXPECT_NEAR(after.cov(1, 1), 4.0 * 0.0004, 1e-12);
  EXPECT_NEAR(after.cov(3, 3), 4.0e-6 + 0.5e-4, 1e-15);
  EXPECT_TRUE(after.mean.isZero(1e-12));
  EXPECT_EQ(updated(after, {}, 2.0).cov, after.cov);
}

TEST(PoseOffsetTest, TurningOnTheSpotMakesTheHeadingUncertain) {
  const Pose turned{expRotation({0.0, 0.0, 1.0}), Eigen::Vector3d::Zero()};
  const PoseOffset after = grown({}, Pose::identity(), turned, {});
  EXPECT_NEAR(std::sqrt(after.cov(3, 3)), OdometryNoise{}.heading_rad_per_sqrt_rad, 1e-9);
  EXPECT_TRUE((after.cov.topLeftCorner<3, 3>().isZero(0.0)));
}

TEST(PoseOffsetTest, AnErrorOfTheHeadingTurnsWhatIsDrivenNext) {
  PoseOffset offset;
  offset.mean[3] = 0.1;
  offset.cov(3, 3) = 1e-4;
  const Pose step{Eigen::Quaterniond::Identity(), {10.0, 0.0, 0.0}};
  const PoseOffset after = grown(offset, Pose::identity(), step, {});
  EXPECT_LT((corrected(step, after).translation_m - expRotation({0.0, 0.0, 0.1}) * step.translation_m).norm(), 1e-9);
  const double across_m2 =
      after.cov(1, 1) - 10.0 * OdometryNoise{}.across_m_per_sqrt_m * OdometryNoise{}.across_m_per_sqrt_m;
  EXPECT_NEAR(across_m2, 1e-2, 5e-4);
  EXPECT_NEAR(after.cov(1, 3), 1e-3 * std::cos(0.1), 1e-9);
}

TEST(PoseOffsetTest, SystematicErrorsOfTheOdometryAreTakenOff) {
  OdometryModel odometry;
  odometry.systematic.scale_translation.mean = 0.1;
  odometry.systematic.scale_turn.mean = -0.03;
  odometry.systematic.heading_rad_per_m.mean = 0.01;
  odometry.systematic.direction_m_per_m.mean = 0.02;
  odometry.systematic.lever_m_per_rad.mean = 0.5;
  const Pose last{expRotation({0.0, 0.0, 0.7}), {5.0, 2.0, 1.0}};
  const Pose step{expRotation({0.0, 0.0, 0.2}), {3.0, 0.0, 0.0}};
  const PoseOffset after = grown({}, last, last * step, odometry);
  const Pose is = last.inverse() * corrected(last * step, after);
  EXPECT_LT((is.translation_m - Eigen::Vector3d(3.3, 0.06 + 0.1, 0.0)).norm(), 1e-9);
  EXPECT_NEAR(headingOf(is.rotation), 0.2 - 0.006 + 0.03, 1e-9);
}

TEST(PoseOffsetTest, HeadingErrorsMovePointsAcrossTheLever) {
  PoseOffset offset;
  offset.cov(3, 3) = 1e-4;
  const Eigen::Matrix3d cov = pointCov(offset, {20.0, 0.0, 0.0});
  EXPECT_NEAR(cov(1, 1), 0.04, 1e-12);
  EXPECT_NEAR(cov(0, 0), 0.0, 1e-12);
  offset.mean = {1.0, 0.0, 0.0, M_PI / 2.0};
  EXPECT_LT(
      (corrected(Pose::identity(), offset) * Eigen::Vector3d(1.0, 0.0, 0.0) - Eigen::Vector3d(1.0, 1.0, 0.0)).norm(),
      1e-12);
}

TEST(PoseOffsetTest, PointsAreAsUncertainAsTheWholeOffsetMakesThem) {
  Rng rng(3);
  PoseOffset offset;
  const Eigen::Matrix4d root = Eigen::Matrix4d::NullaryExpr([&] { return rng.normal(); });
  offset.cov = root * root.transpose();
  const Eigen::Vector3d lever_m(3.0, -7.0, 2.0);
  Eigen::Matrix<double, 3, 4> J = Eigen::Matrix<double, 3, 4>::Zero();
  J.leftCols<3>().setIdentity();
  J.col(3) = Eigen::Vector3d::UnitZ().cross(lever_m);
  EXPECT_TRUE(pointCov(offset, lever_m).isApprox(J * offset.cov * J.transpose(), 1e-12));
}

}  // namespace
}  // namespace semantic_mht_slam
