#pragma once

#include "semantic_mht_slam/models/label_map.h"

namespace semantic_mht_slam {

constexpr std::uint16_t kPoleLabel = 80;
constexpr std::uint16_t kCarLabel = 10;
constexpr std::uint16_t kMovingCarLabel = 252;
constexpr std::uint16_t kWallLabel = 50;
constexpr std::uint16_t kRoadLabel = 40;
constexpr std::uint16_t kUnknownLabel = 77;

constexpr ClassIndex kPole = 0;
constexpr ClassIndex kCar = 1;
constexpr ClassIndex kWall = 2;

/// A thin class, one that drives, and an extended one; ids are the labels above.
inline ClassTable makeExtractionClasses() {
  std::vector<ClassInfo> classes(3);
  classes[kPole].id = kPoleLabel;
  classes[kPole].name = "pole";
  classes[kCar].id = kCarLabel;
  classes[kCar].name = "car";
  classes[kCar].is_static = false;
  classes[kCar].transition = Transition::kGaussian;
  classes[kCar].transition_stddev_m = 0.5;
  classes[kWall].id = kWallLabel;
  classes[kWall].name = "wall";
  classes[kWall].transition = Transition::kGaussian;
  classes[kWall].transition_stddev_m = 2.0;
  return ClassTable(classes, "test");
}

inline LabelMap makeExtractionLabels() {
  return LabelMap(
      {{kPoleLabel, kPole, false}, {kCarLabel, kCar, false}, {kMovingCarLabel, kCar, true}, {kWallLabel, kWall, false}},
      {0, kRoadLabel}, "test");
}

}  // namespace semantic_mht_slam
