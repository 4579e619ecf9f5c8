#include "semantic_mht_slam/evaluation/landmark_error.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

namespace semantic_mht_slam {
namespace {

PointLandmark pole(double x, double y, double z = 0.0) {
  return {{x, y, z}, true, "pole"};
}

LandmarkComparison withLength(double length_m) {
  LandmarkComparison comparison;
  comparison.driven_length_m = length_m;
  return comparison;
}

TEST(LandmarkErrorTest, ThePerfectMapHasNoError) {
  const std::vector<PointLandmark> truth = {pole(0.0, 0.0), pole(5.0, 1.0), pole(-3.0, 8.0)};
  const LandmarkError error = landmarkError(truth, truth, withLength(100.0));
  EXPECT_EQ(error.recall, 1.0);
  EXPECT_EQ(error.precision, 1.0);
  EXPECT_EQ(error.duplicates, 0U);
  EXPECT_EQ(error.ghosts_per_km, 0.0);
  EXPECT_EQ(error.rmse_m, 0.0);
  EXPECT_EQ(error.height_rmse_m, 0.0);
}

TEST(LandmarkErrorTest, TellsDuplicatesFromGhosts) {
  const std::vector<PointLandmark> truth = {pole(0.0, 0.0), pole(10.0, 0.0)};
  const std::vector<PointLandmark> map = {pole(0.3, 0.0), pole(0.0, 0.4), pole(-0.9, 0.0), pole(50.0, 0.0)};
  const LandmarkError error = landmarkError(truth, map, withLength(500.0));
  ASSERT_EQ(error.matches.size(), 1U);
  EXPECT_EQ(error.matches[0].truth, 0U);
  EXPECT_EQ(error.matches[0].mapped, 0U);
  EXPECT_EQ(error.duplicates, 2U);
  EXPECT_EQ(error.ghosts, 1U);
  EXPECT_DOUBLE_EQ(error.recall, 0.5);
  EXPECT_DOUBLE_EQ(error.precision, 0.25);
  EXPECT_DOUBLE_EQ(error.duplicates_per_true, 1.0);
  EXPECT_DOUBLE_EQ(error.ghosts_per_km, 2.0);
}

TEST(LandmarkErrorTest, MeasuresInThePlaneAndHeightsApart) {
  std::vector<PointLandmark> truth = {pole(0.0, 0.0, 1.0), pole(10.0, 0.0, 1.0), pole(20.0, 0.0, 1.0)};
  truth[2].has_height = false;
  const std::vector<PointLandmark> map = {pole(0.3, 0.4, 4.0), pole(10.1, 0.0, 5.0), pole(20.2, 0.0, 90.0)};
  const LandmarkError error = landmarkError(truth, map, {});
  EXPECT_NEAR(error.rmse_m, std::sqrt((0.25 + 0.01 + 0.04) / 3.0), 1e-12);
  EXPECT_NEAR(error.median_m, 0.2, 1e-12);
  EXPECT_NEAR(error.height_rmse_m, std::sqrt((9.0 + 16.0) / 2.0), 1e-12);
  EXPECT_TRUE(std::isnan(error.ghosts_per_km));
}

TEST(LandmarkErrorTest, KnownClassesMustAgreeUnlessIgnored) {
  const std::vector<PointLandmark> truth = {pole(0.0, 0.0)};
  PointLandmark trunk = pole(0.1, 0.0);
  trunk.class_name = "trunk";
  PointLandmark unknown = pole(0.1, 0.0);
  unknown.class_name.clear();
  LandmarkComparison ignoring;
  ignoring.match_class = false;
  EXPECT_EQ(landmarkError(truth, {trunk}, {}).ghosts, 1U);
  EXPECT_EQ(landmarkError(truth, {trunk}, ignoring).matches.size(), 1U);
  EXPECT_EQ(landmarkError(truth, {unknown}, {}).matches.size(), 1U);
}

TEST(LandmarkErrorTest, MovesTheMapByTheAlignment) {
  const std::vector<PointLandmark> truth = {pole(0.0, 0.0, 0.0), pole(30.0, 10.0, 1.0)};
  LandmarkComparison comparison;
  comparison.T_truth_map = {expRotation({0.0, 0.1, 2.0}), {100.0, -20.0, 3.0}};
  std::vector<PointLandmark> map = truth;
  for (PointLandmark& landmark : map) landmark.position_m = comparison.T_truth_map.inverse() * landmark.position_m;
  EXPECT_NEAR(landmarkError(truth, map, comparison).rmse_m, 0.0, 1e-9);
  EXPECT_TRUE(landmarkError(truth, map, {}).matches.empty());
}

TEST(LandmarkErrorTest, TheRadiusIsThePlanarLimit) {
  LandmarkComparison comparison;
  comparison.radius_m = 2.0;
  EXPECT_EQ(landmarkError({pole(0.0, 0.0)}, {pole(2.0, 0.0)}, comparison).matches.size(), 1U);
  EXPECT_EQ(landmarkError({pole(0.0, 0.0)}, {pole(2.001, 0.0)}, comparison).matches.size(), 0U);
}

TEST(LandmarkErrorTest, EmptyListsHaveNoShares) {
  const LandmarkError error = landmarkError({}, {}, withLength(1000.0));
  EXPECT_TRUE(std::isnan(error.recall));
  EXPECT_TRUE(std::isnan(error.precision));
  EXPECT_TRUE(std::isnan(error.rmse_m));
  EXPECT_EQ(error.ghosts_per_km, 0.0);
}

TEST(LandmarkErrorTest, RefusesUnusableInput) {
  LandmarkComparison flat;
  flat.radius_m = 0.0;
  EXPECT_THROW(landmarkError({}, {}, flat), std::invalid_argument);
  EXPECT_THROW(landmarkError({}, {}, withLength(0.0)), std::invalid_argument);
  EXPECT_THROW(landmarkError({pole(std::nan(""), 0.0)}, {}, {}), std::invalid_argument);
  EXPECT_THROW(landmarkError({}, {pole(0.0, 0.0, INFINITY)}, {}), std::invalid_argument);
}

class LandmarkErrorSeedTest : public ::testing::TestWithParam<unsigned> {};

TEST_P(LandmarkErrorSeedTest, MatchesAreOneToOneAndCountsAddUp) {
  std::mt19937 engine(GetParam());
  std::uniform_real_distribution<double> coordinate(0.0, 10.0);
  const auto draw = [&](int count) {
    std::vector<PointLandmark> landmarks;
    for (int i = 0; i < count; ++i) {
      const double x = coordinate(engine);
      landmarks.push_back(pole(x, coordinate(engine)));
    }
    return landmarks;
  };
  const std::vector<PointLandmark> truth = draw(40);
  const std::vector<PointLandmark> map = draw(70);
  const LandmarkError error = landmarkError(truth, map, {});
  std::vector<bool> truth_seen(truth.size(), false);
  std::vector<bool> map_seen(map.size(), false);
  for (const LandmarkMatch& match : error.matches) {
    EXPECT_FALSE(truth_seen[match.truth] || map_seen[match.mapped]);
    truth_seen[match.truth] = map_seen[match.mapped] = true;
    EXPECT_LE(match.distance_m, 1.0);
  }
  EXPECT_EQ(error.matches.size() + error.duplicates + error.ghosts, map.size());
  for (std::size_t i = 0; i < map.size(); ++i) {  // greedy matching leaves no free pair within the radius
    for (std::size_t j = 0; j < truth.size(); ++j) {
      const double distance_m = (map[i].position_m - truth[j].position_m).norm();
      EXPECT_TRUE(distance_m > 1.0 || map_seen[i] || truth_seen[j]);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, LandmarkErrorSeedTest, ::testing::Range(0U, 20U));

}  // namespace
}  // namespace semantic_mht_slam
