#include "semantic_mht_slam/mapping/odometry_learning.h"

#include <cmath>

#include <gtest/gtest.h>

#include "semantic_mht_slam/common/random.h"
#include "semantic_mht_slam/common/state_archive.h"

namespace semantic_mht_slam {
namespace {

constexpr int kSteps = 8;
constexpr double kStep_m = 4.0;
constexpr double kDetector_m = 0.1;

/// What the odometry makes of a true step of a vehicle on the plane.
Pose measured(const Pose& step, const OdometryModel& odometry, Rng& rng) {
  const Motion motion = motionOf(step);
  const MotionVariance variance = varianceOf(odometry.noise, motion);
  Pose seen = step;
  seen.translation_m.x() += rng.normal(0.0, std::sqrt(variance.along_m2));
  seen.translation_m.y() += rng.normal(0.0, std::sqrt(variance.across_m2));
  seen.translation_m.z() += rng.normal(0.0, std::sqrt(variance.up_m2));
  const double turn_rad = headingOf(step.rotation) / (1.0 + odometry.systematic.scale_turn.mean);
  seen.rotation = expRotation({0.0, 0.0, turn_rad + rng.normal(0.0, std::sqrt(variance.heading_rad2))});
  return seen;
}

/// A stretch among poles with turns of up to 0.8 rad a step; a share of the associations is wrong, all ranges are so
/// many times too long.
OdometryStretch drive(const OdometryModel& odometry, Rng& rng, double wrong_share = 0.0, double range_scale = 1.0) {
  OdometryStretch stretch;
  std::vector<Eigen::Vector3d> poles;
  for (int i = 0; i < 30; ++i)
    poles.push_back({rng.uniform(-30.0, 50.0), rng.uniform(-40.0, 40.0), rng.uniform(-1.0, 1.0)});
  Pose is = Pose::identity();
  Pose odom = Pose::identity();
  for (int k = 0; k <= kSteps; ++k) {
    stretch.T_stretch_base.push_back(odom);
    for (std::size_t i = 0; i < poles.size(); ++i) {
      Eigen::Vector3d seen_m = is.inverse() * poles[i];
      if (seen_m.norm() > 25.0) continue;
      seen_m *= range_scale;
      for (int axis = 0; axis < 3; ++axis) seen_m[axis] += rng.normal(0.0, kDetector_m);
      const std::size_t id = rng.bernoulli(wrong_share) ? static_cast<std::size_t>(rng.index(30)) : i;
      stretch.observations.push_back({k, seen_m, kDetector_m * kDetector_m * Eigen::Matrix3d::Identity(), id + 1});
    }
    const Pose step{expRotation({0.0, 0.0, k % 2 == 0 ? 0.0 : rng.uniform(-0.8, 0.8)}), {kStep_m, 0.0, 0.0}};
    if (k < kSteps) stretch.motion.push_back(motionOf(step));
    is = is * step;
    odom = odom * measured(step, odometry, rng);
  }
  return stretch;
}

OdometryModel wheels() {
  OdometryModel odometry;
  odometry.noise = {0.05, 0.02, 0.05, 0.0005, 0.03, 0.0};
  odometry.systematic.scale_turn.mean = -0.03;
  return odometry;
}

OdometryModel visual() {
  OdometryModel odometry;
  odometry.noise = {0.015, 0.01, 0.01, 0.0001, 0.004, 0.0002};
  return odometry;
}

OdometryLearning learnedFrom(const OdometryModel& odometry, int stretches, std::uint64_t seed,
                             double wrong_share = 0.0) {
  OdometryLearning learning({});
  Rng rng(seed);
  for (int i = 0; i < stretches; ++i) learning.add(drive(odometry, rng, wrong_share));
  return learning;
}

void expectWithin(double factor, double is, double wanted) {
  EXPECT_GT(is, wanted / factor);
  EXPECT_LT(is, wanted * factor);
}

TEST(OdometryLearningTest, BeginsWithWhatIsConfigured) {
  const OdometryLearning learning({});
  EXPECT_NEAR(learning.model().noise.heading_rad_per_sqrt_rad, OdometryNoise{}.heading_rad_per_sqrt_rad, 1e-12);
  EXPECT_EQ(learning.model().systematic.scale_turn.mean, 0.0);
}

TEST(OdometryLearningTest, FindsTheNoiseOfWheelsFromDetectionsAlone) {
  const OdometryModel learned = learnedFrom(wheels(), 40, 1).model();
  expectWithin(1.3, learned.noise.along_m_per_sqrt_m, 0.05);
  expectWithin(1.5, learned.noise.across_m_per_sqrt_m, 0.02);
  expectWithin(1.4, learned.noise.heading_rad_per_sqrt_rad, 0.03);
  EXPECT_LT(learned.noise.heading_rad_per_sqrt_m, 0.0015);
  expectWithin(1.6, learned.noise.up_m_per_sqrt_m, 0.05);
}

TEST(OdometryLearningTest, FindsThatTheOdometryTurnsTooFar) {
  const CoefficientEstimate turn = learnedFrom(wheels(), 40, 2).model().systematic.scale_turn;
  EXPECT_LT(turn.stddev, 0.008);
  EXPECT_NEAR(turn.mean, -0.03, 3.0 * turn.stddev);
}

TEST(OdometryLearningTest, AScaleOfTheRangesIsNotTakenForOneOfTheOdometryWithoutDoubt) {
  for (const double range_scale : {0.99, 1.0, 1.01}) {
    OdometryLearning learning({});
    Rng rng(9);
    for (int i = 0; i < 40; ++i) learning.add(drive(wheels(), rng, 0.0, range_scale));
    const CoefficientEstimate scale = learning.model().systematic.scale_translation;
    EXPECT_NEAR(scale.mean, 0.0, 2.5 * scale.stddev) << range_scale;
    EXPECT_LT(scale.stddev, 0.01) << range_scale;
  }
}

TEST(OdometryLearningTest, AScaleIsAppliedAsFarAsItExceedsItsDoubt) {
  const auto learned = [](double range_scale) {
    OdometryLearning learning({});
    Rng rng(10);
    for (int i = 0; i < 40; ++i) learning.add(drive(wheels(), rng, 0.0, range_scale));
    return learning.model().systematic.scale_translation.mean;
  };
  EXPECT_EQ(learned(1.0), 0.0);
  EXPECT_NEAR(learned(0.95), -0.05, 0.01);
}

TEST(OdometryLearningTest, WhatTheFirstStretchesCannotTellIsNotApplied) {
  int applied = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const SystematicErrors errors = learnedFrom(visual(), 3, seed).model().systematic;
    applied += errors.scale_turn.mean != 0.0;
    applied += errors.heading_rad_per_m.mean != 0.0;
  }
  EXPECT_LT(applied, 20);  // an estimate of nothing exceeds its standard deviation in a third of the 40 cases
}

TEST(OdometryLearningTest, TellsAGoodOdometryFromABadOne) {
  const OdometryNoise learned = learnedFrom(visual(), 40, 3).model().noise;
  expectWithin(1.5, learned.along_m_per_sqrt_m, 0.015);
  expectWithin(1.5, learned.heading_rad_per_sqrt_rad, 0.004);
  EXPECT_LT(learned.heading_rad_per_sqrt_m, 0.0005);
}

TEST(OdometryLearningTest, IsHonestOfTheHeadingAfterTheFirstStretches) {
  double nees = 0.0;
  int count = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const OdometryModel learned = learnedFrom(wheels(), 3, seed).model();
    Rng rng(1000 + seed);
    for (int i = 0; i < 50; ++i) {
      const Pose step{expRotation({0.0, 0.0, 0.4}), {kStep_m, 0.0, 0.0}};
      const Pose odom = measured(step, wheels(), rng);
      const double error_rad = headingOf(expectedStep(learned, odom).rotation.conjugate() * step.rotation);
      nees += error_rad * error_rad / varianceOf(learned, motionOf(odom)).heading_rad2;
      ++count;
    }
  }
  expectWithin(2.0, nees / count, 1.0);
}

TEST(OdometryLearningTest, SomeWrongAssociationsHardlyChangeIt) {
  const OdometryNoise learned = learnedFrom(wheels(), 40, 4, 0.03).model().noise;
  expectWithin(1.8, learned.along_m_per_sqrt_m, 0.05);
  expectWithin(1.8, learned.heading_rad_per_sqrt_rad, 0.03);
}

TEST(OdometryLearningTest, NothingSeenTwiceSaysNothing) {
  OdometryLearning learning({});
  Rng rng(5);
  OdometryStretch stretch = drive(wheels(), rng);
  for (std::size_t i = 0; i < stretch.observations.size(); ++i) stretch.observations[i].landmark = i + 1;
  learning.add(stretch);
  EXPECT_NEAR(learning.model().noise.along_m_per_sqrt_m, OdometryNoise{}.along_m_per_sqrt_m, 1e-12);
}

TEST(OdometryLearningTest, SwitchedOffItKeepsWhatIsConfigured) {
  OdometryConfig config;
  config.learn = false;
  OdometryLearning learning(config);
  Rng rng(6);
  for (int i = 0; i < 5; ++i) learning.add(drive(wheels(), rng));
  EXPECT_EQ(learning.model().noise.along_m_per_sqrt_m, config.noise.along_m_per_sqrt_m);
}

TEST(OdometryLearningTest, GoesOnFromAState) {
  OdometryLearning learning = learnedFrom(wheels(), 15, 7);
  StateArchive writing;
  learning.transfer(writing);
  OdometryLearning restored({});
  const std::string reading_bytes = writing.written();
  StateArchive reading(reading_bytes);
  restored.transfer(reading);
  Rng a(8);
  Rng b(8);
  learning.add(drive(wheels(), a));
  restored.add(drive(wheels(), b));
  EXPECT_EQ(learning.model().noise.along_m_per_sqrt_m, restored.model().noise.along_m_per_sqrt_m);
  EXPECT_EQ(learning.model().systematic.scale_turn.mean, restored.model().systematic.scale_turn.mean);
}

}  // namespace
}  // namespace semantic_mht_slam
