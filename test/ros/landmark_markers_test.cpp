#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "semantic_mht_slam/ros/markers.h"

#include "support/recordings.h"

namespace semantic_mht_slam {
namespace {

/// Two poles that are well known, one of them undecided, and a third that hardly exists.
SemanticMap makeDrawnMap() {
  SemanticMap map;
  map.header.frame_id = "map";
  map.landmarks.resize(3);
  for (std::size_t i = 0; i < 3; ++i) {
    Landmark& landmark = map.landmarks[i];
    landmark.id = 10 + i;
    landmark.class_id = 7;
    landmark.existence_prob = i < 2 ? 0.9 : 0.1;
    landmark.components.resize(i == 1 ? 2 : 1);
    for (GaussianComponent& component : landmark.components) {
      component.weight = 1.0 / static_cast<double>(landmark.components.size());
      component.covariance = {0.01, 0, 0, 0, 0.01, 0, 0, 0, 0.01};
    }
  }
  map.landmarks[1].undecided = true;
  return map;
}

std::multiset<std::string> namespaces(const visualization_msgs::MarkerArray& array) {
  std::multiset<std::string> names;
  for (std::size_t i = 1; i < array.markers.size(); ++i) names.insert(array.markers[i].ns);
  return names;
}

TEST(LandmarkMarkersTest, SmallOnesShareAMarkerAndDoubtfulOnesAreNotShown) {
  const visualization_msgs::MarkerArray array = toLandmarkMarkers(makeDrawnMap(), makeTwoClasses(), 1.0, {});
  EXPECT_EQ(array.markers.front().action, visualization_msgs::Marker::DELETEALL);
  EXPECT_EQ(namespaces(array), (std::multiset<std::string>{"pole", "undecided"}));
  EXPECT_EQ(array.markers.back().type, visualization_msgs::Marker::SPHERE_LIST);
  EXPECT_EQ(array.markers.back().points.size(), 3U) << "one component and two";
  EXPECT_EQ(array.markers.back().colors.size(), 3U);
}

TEST(LandmarkMarkersTest, LargeOnesAreEllipsoidsOfTheChosenSize) {
  SemanticMap map = makeDrawnMap();
  map.landmarks.resize(1);
  map.landmarks[0].components[0].covariance = {4.0, 0, 0, 0, 1.0, 0, 0, 0, 1.0};
  LiveConfig live;
  live.landmark_sigmas = 3.0;
  const visualization_msgs::MarkerArray array = toLandmarkMarkers(map, makeTwoClasses(), 1.0, live);
  ASSERT_EQ(array.markers.size(), 2U);
  const visualization_msgs::Marker& marker = array.markers[1];
  EXPECT_EQ(marker.type, visualization_msgs::Marker::SPHERE);
  EXPECT_NEAR(std::max({marker.scale.x, marker.scale.y, marker.scale.z}), 2.0 * 3.0 * 2.0, 1e-9);
  EXPECT_NEAR(std::min({marker.scale.x, marker.scale.y, marker.scale.z}), 2.0 * 3.0 * 1.0, 1e-9);
}

TEST(LandmarkMarkersTest, ObjectsOfAKnownSizeHaveABodyUnlessTheSymbolHidesIt) {
  SemanticMap map = makeDrawnMap();
  map.landmarks.resize(1);
  map.landmarks[0].size.x = 1.0;
  map.landmarks[0].size.y = 3.0;
  map.landmarks[0].size.z = 5.0;
  const visualization_msgs::MarkerArray array = toLandmarkMarkers(map, makeTwoClasses(), 1.0, {});
  ASSERT_EQ(namespaces(array).count("sizes"), 1U);
  const visualization_msgs::Marker& body = array.markers[1];
  EXPECT_EQ(body.type, visualization_msgs::Marker::CYLINDER);
  EXPECT_EQ(body.scale.x, 2.0) << "its heading is not known";
  EXPECT_EQ(body.scale.y, 2.0);
  EXPECT_EQ(body.scale.z, 5.0);
  EXPECT_EQ(namespaces(toLandmarkMarkers(map, makeTwoClasses(), 10.0, {})).count("sizes"), 0U);
}

TEST(LandmarkMarkersTest, LabelsAndTheLimitOfExistenceFollowTheLiveParameters) {
  LiveConfig live;
  live.landmark_labels = true;
  live.landmark_min_existence_prob = 0.0;
  const visualization_msgs::MarkerArray array = toLandmarkMarkers(makeDrawnMap(), makeTwoClasses(), 1.0, live);
  EXPECT_EQ(namespaces(array).count("labels"), 3U);
}

TEST(LandmarkMarkersTest, SymbolsAreAsSmallAsAskedForAndProvisionalOnesFainter) {
  SemanticMap map = makeDrawnMap();
  map.landmarks.resize(1);
  map.landmarks.push_back(map.landmarks[0]);
  map.landmarks[1].provisional = true;
  for (Landmark& landmark : map.landmarks) landmark.components[0].covariance = {1e-6, 0, 0, 0, 1e-6, 0, 0, 0, 1e-6};
  const visualization_msgs::MarkerArray array = toLandmarkMarkers(map, makeTwoClasses(), 0.1, {});
  const visualization_msgs::Marker& dots = array.markers.back();
  EXPECT_DOUBLE_EQ(dots.scale.x, 0.2);
  ASSERT_EQ(dots.colors.size(), 2U);
  EXPECT_LT(dots.colors[1].a, 0.6F * dots.colors[0].a);
}

}  // namespace
}  // namespace semantic_mht_slam
