#include "semantic_mht_slam/slam/place_units.h"

#include <gtest/gtest.h>

namespace semantic_mht_slam {
namespace {

TEST(PlaceUnitsTest, WhatGoesInComesOut) {
  const PlaceUnits units(0.25);
  const Pose pose{expRotation({0.1, 0.2, 0.3}), {1.0, 2.0, 3.0}};
  PlaceMatch match;
  match.T_match_query = units.toPlaces(pose);
  EXPECT_EQ(match.T_match_query.translation_m, Eigen::Vector3d(4.0, 8.0, 12.0));
  match.cov.setIdentity();
  match.cov(0, 5) = match.cov(5, 0) = 0.5;
  const PlaceMatch back = units.fromPlaces(match);
  EXPECT_EQ(back.T_match_query.translation_m, pose.translation_m);
  EXPECT_EQ(back.cov(0, 0), 1.0 / 16.0);
  EXPECT_EQ(back.cov(0, 5), 0.125);
  EXPECT_EQ(back.cov(5, 5), 1.0);
}

TEST(PlaceUnitsTest, ScenesAreScaledWithTheirUncertainty) {
  Scene scene;
  scene.objects.emplace_back();
  scene.objects[0].position_m = {1.0, 0.0, 0.0};
  const Scene in_places = PlaceUnits(0.5).toPlaces(scene);
  EXPECT_EQ(in_places.objects[0].position_m.x(), 2.0);
  EXPECT_EQ(in_places.objects[0].cov_m2(0, 0), 4.0);
}

}  // namespace
}  // namespace semantic_mht_slam
