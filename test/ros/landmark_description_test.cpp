#include "semantic_mht_slam/ros/landmark_description.h"

#include <gtest/gtest.h>

namespace semantic_mht_slam {
namespace {

Landmark landmarkAt(std::uint64_t id, double x, double y, double z) {
  Landmark landmark;
  landmark.id = id;
  landmark.class_id = 9;
  landmark.class_probs = {0.25, 0.75};
  landmark.position.x = x;
  landmark.position.y = y;
  landmark.position.z = z;
  landmark.existence_prob = 0.9;
  return landmark;
}

SemanticMap makeMap() {
  SemanticMap map;
  map.classes.resize(2);
  map.classes[0].id = 7;
  map.classes[0].name = "pole";
  map.classes[1].id = 9;
  map.classes[1].name = "trunk";
  map.landmarks = {landmarkAt(1, 0.0, 0.0, 0.0), landmarkAt(2, 3.0, 0.0, 50.0), landmarkAt(3, 100.0, 0.0, 0.0)};
  return map;
}

geometry_msgs::Point pointAt(double x, double y) {
  geometry_msgs::Point point;
  point.x = x;
  point.y = y;
  return point;
}

TEST(LandmarkDescriptionTest, NearestIsSeenFromAboveAndWithinTheLimit) {
  const SemanticMap map = makeMap();
  ASSERT_NE(nearestLandmark(map, pointAt(2.0, 0.0), 5.0), nullptr);
  EXPECT_EQ(nearestLandmark(map, pointAt(2.0, 0.0), 5.0)->id, 2U) << "its height must not count";
  EXPECT_EQ(nearestLandmark(map, pointAt(50.0, 0.0), 5.0), nullptr);
  EXPECT_EQ(nearestLandmark(SemanticMap(), pointAt(0.0, 0.0), 5.0), nullptr);
}

TEST(LandmarkDescriptionTest, EveryAlternativeTheHistoryAndTheClassesAreTold) {
  const SemanticMap map = makeMap();
  Landmark landmark = map.landmarks.front();
  landmark.undecided = true;
  landmark.observations = 12;
  landmark.first_submap = 3;
  landmark.last_submap = 5;
  landmark.merged_ids = {40, 51};
  landmark.components.resize(2);
  landmark.components[0].weight = 0.6;
  landmark.components[0].mean = pointAt(1.0, 2.0);
  landmark.components[0].covariance[0] = 0.25;
  landmark.components[1].weight = 0.4;
  const std::vector<std::string> expected = {"trunk 1, exists with 90 %, undecided", "classes: trunk 75 %, pole 25 %",
                                             "seen 12 times, in submaps 3 to 5; took over the ids 40, 51",
                                             "60 % at (1.0, 2.0, 0.0) m, +-0.50 m",
                                             "40 % at (0.0, 0.0, 0.0) m, +-0.00 m"};
  EXPECT_EQ(describeLandmark(map, landmark), expected);
}

}  // namespace
}  // namespace semantic_mht_slam
