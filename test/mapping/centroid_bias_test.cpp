#include "semantic_mht_slam/mapping/centroid_bias.h"

#include <cmath>

#include <gtest/gtest.h>

#include "semantic_mht_slam/common/random.h"
#include "semantic_mht_slam/common/state_archive.h"

namespace semantic_mht_slam {
namespace {

constexpr double kKeyframeSpacing_m = 2.0;
constexpr int kKeyframes = 16;
constexpr double kNoise_m = 0.05;
const OdometryNoise kOdometry{0.03, 0.03, 0.03, 0.0007, 0.0, 0.0007};

enum Class { kBuilding, kPole, kVehicle };  // the first has no bias

/// A class has a bias unless its landmarks move by more than 0.4 m.
ClassTable makeBiasedTable(double building_moves_m = 2.0, double vehicle_moves_m = 0.4) {
  std::vector<ClassInfo> classes(3);
  classes[kPole].name = "pole";
  classes[kVehicle] = {1, "vehicle", "#000000", false, 1.0, 0.4, 0.4, Transition::kGaussian, vehicle_moves_m};
  classes[kBuilding] = {2, "building", "#000000", true, 1.0, 0.4, 0.4, Transition::kGaussian, building_moves_m};
  return ClassTable(classes, "test");
}

double trueBias(ClassIndex c, double range_m) {
  return c == kPole ? -0.05 - 0.001 * range_m : -0.3 - 0.004 * range_m;
}

double trueHeight(ClassIndex c, double range_m) {
  return c == kPole ? 0.01 * range_m : 0.0;
}

/// A stretch of a drive along rows of poles and cars; the odometry's steps are too long by the factor `1 + scale_error`
/// and its heading wanders.
BiasStretch drive(Rng& rng, double scale_error, bool is_biased) {
  BiasStretch stretch;
  std::vector<Eigen::Vector3d> objects;
  for (int i = 0; i < 24; ++i) {
    const double side = i % 2 == 0 ? 1.0 : -1.0;
    objects.push_back({rng.uniform(-25.0, 60.0), side * rng.uniform(4.0, 12.0), rng.uniform(-0.5, 0.5)});
  }
  const Eigen::AngleAxisd climb(-0.03, Eigen::Vector3d::UnitY());
  Pose odometry{Eigen::Quaterniond(climb), {5.0, -3.0, 1.0}};
  double x_m = 0.0;
  for (int k = 0; k < kKeyframes; ++k) {
    stretch.T_stretch_base.push_back(odometry);
    for (std::size_t i = 0; i < objects.size(); ++i) {
      const Eigen::Vector3d true_m = objects[i] - Eigen::Vector3d(x_m, 0.0, 0.0);
      const double range_m = true_m.norm();
      if (range_m > 45.0 || !rng.bernoulli(0.7)) continue;
      BiasObservation seen;
      seen.keyframe = k;
      seen.class_index = static_cast<ClassIndex>(i % 4 < 2 ? kPole : kVehicle);
      seen.landmark = i + 1;
      seen.position_m = true_m + kNoise_m * Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal());
      if (is_biased) {
        seen.position_m += trueBias(seen.class_index, range_m) / range_m * true_m;
        seen.position_m.z() += trueHeight(seen.class_index, range_m);
      }
      if (rng.bernoulli(0.03)) seen.position_m.y() += 3.0;  // a wrong association
      seen.cov_m2 = kNoise_m * kNoise_m * Eigen::Matrix3d::Identity();
      stretch.observations.push_back(seen);
    }
    x_m += kKeyframeSpacing_m;
    const double turn = rng.normal(0.0, 0.0007 * std::sqrt(kKeyframeSpacing_m));
    const Pose step{expRotation({0.0, 0.0, turn}), {kKeyframeSpacing_m * (1.0 + scale_error), 0.0, 0.0}};
    odometry = odometry * step;
  }
  return stretch;
}

CentroidBias estimate(std::uint64_t seed, double scale_error, bool is_biased, int stretches = 60) {
  CentroidBias bias({}, makeBiasedTable());
  Rng rng(seed);
  for (int i = 0; i < stretches; ++i) bias.add(drive(rng, scale_error, is_biased), kOdometry);
  return bias;
}

class CentroidBiasWithScaleError : public testing::TestWithParam<double> {};

TEST_P(CentroidBiasWithScaleError, IsFoundAlongTheLineOfSight) {
  const CentroidBias bias = estimate(1, GetParam(), true);
  for (const ClassIndex c : {kPole, kVehicle}) {
    for (const double range_m : {8.0, 15.0, 25.0, 35.0}) {
      EXPECT_NEAR(bias.at(c, range_m).range_m, trueBias(c, range_m), 0.015 + 0.0025 * range_m) << c << " " << range_m;
    }
  }
}

TEST_P(CentroidBiasWithScaleError, HeightIsFoundAgainstThatFromNear) {
  const CentroidBias bias = estimate(2, GetParam(), true);
  for (const ClassIndex c : {kPole, kVehicle}) {
    const double change_m = bias.at(c, 35.0).height_m - bias.at(c, 10.0).height_m;
    EXPECT_NEAR(change_m, trueHeight(c, 35.0) - trueHeight(c, 10.0), 0.04);
  }
}

TEST_P(CentroidBiasWithScaleError, IsNotInventedWhereThereIsNone) {
  const CentroidBias bias = estimate(3, GetParam(), false);
  EXPECT_NEAR(bias.odometryScale(), 1.0 / (1.0 + GetParam()) - 1.0, 0.003);
  EXPECT_LT(std::abs(bias.odometryScale() - (1.0 / (1.0 + GetParam()) - 1.0)), 4.0 * bias.scaleStddev());
  EXPECT_LT(bias.scaleStddev(), 0.01) << "less than before anything was seen";
  for (const ClassIndex c : {kPole, kVehicle}) {
    for (const double range_m : {8.0, 15.0, 25.0, 35.0}) {
      EXPECT_NEAR(bias.at(c, range_m).range_m, 0.0, 0.01 + 0.0015 * range_m) << c << " " << range_m;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Errors, CentroidBiasWithScaleError, testing::Values(-0.02, 0.0, 0.015));

TEST(CentroidBiasTest, IsZeroBeforeAnythingWasSeenAndNoMoreUncertainThanTheClassTable) {
  const CentroidBias bias({}, makeBiasedTable());
  EXPECT_EQ(bias.at(kPole, 20.0).range_m, 0.0);
  const Eigen::Matrix3d cov = bias.uncertainty(kPole, {20.0, 0.0, 0.0});
  EXPECT_NEAR(cov(0, 0), 0.01, 1e-9);  // range_stddev of the table: 0.1 m
  EXPECT_NEAR(cov(1, 1), 0.0, 1e-12);
}

TEST(CentroidBiasTest, StaticObjectsThatAreSeenAlikeFromEverywhereHaveOnePlace) {
  const CentroidBias bias({}, makeBiasedTable());
  EXPECT_TRUE(bias.hasOnePlace(kPole));
  EXPECT_FALSE(bias.hasOnePlace(kBuilding)) << "another part of it is seen from elsewhere";
  EXPECT_FALSE(bias.hasOnePlace(kVehicle)) << "it may drive";
}

TEST(CentroidBiasTest, UncertaintyFallsWithEvidence) {
  const double first = estimate(4, 0.0, true, 1).at(kPole, 25.0).range_variance_m2;
  const double second = estimate(4, 0.0, true, 20).at(kPole, 25.0).range_variance_m2;
  EXPECT_LT(second, 0.9 * first);
}

TEST(CentroidBiasTest, CorrectionUndoesIt) {
  const CentroidBias bias = estimate(5, 0.0, true);
  Detection detection;
  detection.class_index = kVehicle;
  detection.position_m = (20.0 + bias.at(kVehicle, 20.0).range_m) * Eigen::Vector3d(0.6, 0.8, 0.0);
  detection.cov_m2 = 0.01 * Eigen::Matrix3d::Identity();
  const Detection corrected = bias.corrected(detection);
  EXPECT_NEAR(corrected.position_m.head<2>().norm(), 20.0, 0.01);
  EXPECT_GT(corrected.cov_m2->trace(), detection.cov_m2->trace());
}

TEST(CentroidBiasTest, ExtendedObjectsAreLeftAlone) {
  const CentroidBias bias = estimate(6, 0.0, true);
  Detection detection;
  detection.class_index = kBuilding;
  detection.position_m = {20.0, 3.0, 1.0};
  EXPECT_EQ(bias.corrected(detection).position_m, detection.position_m);
}

/// What is left of a bias for a program with another class table.
CentroidBias loaded(CentroidBias& saved, const ClassTable& classes) {
  StateArchive writing;
  saved.transfer(writing);
  const std::string reading_bytes = writing.written();
  StateArchive reading(reading_bytes);
  CentroidBias result({}, classes);
  result.transfer(reading);
  return result;
}

TEST(CentroidBiasTest, ItIsKeptByClassWhicheverOfThemHaveOne) {
  CentroidBias bias = estimate(3, 0.0, true);
  const CentroidBias same = loaded(bias, makeBiasedTable());
  const CentroidBias all = loaded(bias, makeBiasedTable(0.4, 0.4));
  const CentroidBias swapped = loaded(bias, makeBiasedTable(0.4, 2.0));
  for (const double range_m : {5.0, 20.0, 35.0}) {
    EXPECT_EQ(same.at(kVehicle, range_m).range_m, bias.at(kVehicle, range_m).range_m);
    EXPECT_EQ(same.at(kPole, range_m).height_variance_m2, bias.at(kPole, range_m).height_variance_m2);
    EXPECT_NEAR(all.at(kVehicle, range_m).range_m, bias.at(kVehicle, range_m).range_m, 1e-9);
    EXPECT_NEAR(all.at(kPole, range_m).height_m, bias.at(kPole, range_m).height_m, 1e-9);
    for (const CentroidBias* other : {&all, &swapped}) {
      EXPECT_EQ(other->at(kBuilding, range_m).range_m, 0.0);
      EXPECT_GT(other->at(kBuilding, range_m).range_variance_m2, 0.1);
    }
    EXPECT_EQ(swapped.at(kVehicle, range_m).range_m, 0.0);
    EXPECT_EQ(swapped.at(kVehicle, range_m).range_variance_m2, 0.0);
    EXPECT_NEAR(swapped.at(kPole, range_m).range_m, bias.at(kPole, range_m).range_m, 1e-9);
  }
  EXPECT_NEAR(all.odometryScale(), bias.odometryScale(), 1e-9);
  EXPECT_NEAR(swapped.odometryScale(), bias.odometryScale(), 1e-9);
}

TEST(CentroidBiasTest, SwitchedOffItDoesNothing) {
  BiasConfig config;
  config.enabled = false;
  CentroidBias bias(config, makeBiasedTable());
  Rng rng(7);
  bias.add(drive(rng, 0.0, true), kOdometry);
  EXPECT_EQ(bias.at(kVehicle, 20.0).range_m, 0.0);
  EXPECT_TRUE(bias.uncertainty(kVehicle, {20.0, 0.0, 0.0}).isZero(0.0));
}

TEST(CentroidBiasTest, OrderOfObservationsDoesNotMatter) {
  Rng rng(8);
  BiasStretch stretch = drive(rng, 0.0, true);
  CentroidBias a({}, makeBiasedTable());
  a.add(stretch, kOdometry);
  std::reverse(stretch.observations.begin(), stretch.observations.end());
  CentroidBias b({}, makeBiasedTable());
  b.add(stretch, kOdometry);
  EXPECT_NEAR(a.at(kVehicle, 20.0).range_m, b.at(kVehicle, 20.0).range_m, 1e-9);
}

}  // namespace
}  // namespace semantic_mht_slam
