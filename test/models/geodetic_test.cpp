#include "semantic_mht_slam/models/geodetic.h"

#include <limits>

#include <gtest/gtest.h>

namespace semantic_mht_slam {
namespace {

const GeodeticPoint kOrigin{47.3769, 8.5417, 408.0};

TEST(GeodeticTest, NorthEastAndUpAreWhereTheyAre) {
  EXPECT_LT(toEastNorthUp(kOrigin, kOrigin).norm(), 1e-6);
  const Eigen::Vector3d north_m = toEastNorthUp(kOrigin, {kOrigin.latitude_deg + 0.001, kOrigin.longitude_deg, 408.0});
  EXPECT_NEAR(north_m.y(), 111.2, 0.1);  // a thousandth of a degree of the meridian there
  EXPECT_NEAR(north_m.x(), 0.0, 1e-6);
  const Eigen::Vector3d east_m = toEastNorthUp(kOrigin, {kOrigin.latitude_deg, kOrigin.longitude_deg + 0.001, 408.0});
  EXPECT_NEAR(east_m.x(), 75.5, 0.1);
  EXPECT_NEAR(east_m.y(), 0.0, 1e-3);
  const Eigen::Vector3d up_m = toEastNorthUp(kOrigin, {kOrigin.latitude_deg, kOrigin.longitude_deg, 418.0});
  EXPECT_LT((up_m - Eigen::Vector3d(0.0, 0.0, 10.0)).norm(), 1e-6);
}

TEST(GeodeticTest, ThereAndBackIsTheSamePlace) {
  const Eigen::Vector3d place_m(1234.5, -987.6, 12.3);
  EXPECT_LT((toEastNorthUp(kOrigin, toGeodetic(kOrigin, place_m)) - place_m).norm(), 1e-6);
}

TEST(GeodeticTest, WhatIsNotOnTheEarth) {
  EXPECT_TRUE(isOnEarth(kOrigin));
  EXPECT_FALSE(isOnEarth({90.1, 0.0, 0.0}));
  EXPECT_FALSE(isOnEarth({0.0, -180.1, 0.0}));
  EXPECT_FALSE(isOnEarth({0.0, 0.0, 1e6}));
  EXPECT_FALSE(isOnEarth({std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0}));
  EXPECT_FALSE(isOnEarth({0.0, 0.0, std::numeric_limits<double>::quiet_NaN()}));
}

}  // namespace
}  // namespace semantic_mht_slam
