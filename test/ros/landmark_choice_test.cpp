#include "semantic_mht_slam/ros/landmark_choice.h"

#include <limits>

#include <gtest/gtest.h>

#include "semantic_mht_slam/common/error.h"

namespace semantic_mht_slam {
namespace {

/// A pole, a trunk and a pole at x = 0, 10 and 20 m.
SemanticMap makeRow() {
  SemanticMap map;
  map.classes.resize(2);
  map.classes[0].id = 7;
  map.classes[0].name = "pole";
  map.classes[1].id = 8;
  map.classes[1].name = "trunk";
  for (std::uint16_t i = 0; i < 3; ++i) {
    map.landmarks.emplace_back();
    map.landmarks.back().id = 10U + i;
    map.landmarks.back().class_id = i == 1 ? 8 : 7;
    map.landmarks.back().position.x = 10.0 * i;
  }
  return map;
}

std::vector<std::uint64_t> idsOf(const std::vector<Landmark>& landmarks) {
  std::vector<std::uint64_t> ids;
  for (const Landmark& landmark : landmarks) ids.push_back(landmark.id);
  return ids;
}

using Ids = std::vector<std::uint64_t>;

TEST(LandmarkChoiceTest, ByClassAndPlace) {
  GetLandmarks::Request request;
  EXPECT_EQ(idsOf(chosenLandmarks(makeRow(), request)), (Ids{10, 11, 12}));
  request.class_name = "pole";
  EXPECT_EQ(idsOf(chosenLandmarks(makeRow(), request)), (Ids{10, 12}));
  request.center.x = 19.0;
  request.radius = 5.0;
  EXPECT_EQ(idsOf(chosenLandmarks(makeRow(), request)), (Ids{12}));
  request.class_name = "";
  request.radius = 10.0;
  EXPECT_EQ(idsOf(chosenLandmarks(makeRow(), request)), (Ids{11, 12}));
}

TEST(LandmarkChoiceTest, RequestsThatMakeNoSenseAreRefused) {
  GetLandmarks::Request request;
  request.class_name = "tree";
  EXPECT_THROW(chosenLandmarks(makeRow(), request), InputError);
  request = {};
  request.radius = -1.0;
  EXPECT_THROW(chosenLandmarks(makeRow(), request), InputError);
  request.radius = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(chosenLandmarks(makeRow(), request), InputError);
  request = {};
  request.center.y = std::numeric_limits<double>::infinity();
  EXPECT_THROW(chosenLandmarks(makeRow(), request), InputError);
}

}  // namespace
}  // namespace semantic_mht_slam
