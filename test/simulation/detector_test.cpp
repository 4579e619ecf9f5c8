#include "semantic_mht_slam/simulation/detector.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <gtest/gtest.h>

#include "semantic_mht_slam/common/error.h"

#include "scenario_files.h"

namespace semantic_mht_slam {
namespace {

constexpr int kFrames = 2000;

/// A sensor that stands at the origin, and a detector without any error until a test sets one.
class DetectorTest : public testing::Test {
 protected:
  DetectorTest() : indices_(townClassIndices(simulationClasses())) {
    motion_.T_world_base.assign(kFrames, Pose::identity());
    scenario_.detector.hidden_pass_prob = 0.0;
    scenario_.detector.confusion_prob = 0.0;
    scenario_.detector.clutter_mean = 0.0;
    scenario_.detector.missed_frame_prob = 0.0;
    for (TownClassConfig& config : scenario_.classes.items) {
      config.detection_prob = 1.0;
      config.half_range_m = 200.0;
      config.range_stddev_m = config.lateral_stddev_m = config.height_noise_stddev_m = 0.0;
      config.range_bias_m = config.range_bias_per_m = config.height_bias_per_m = 0.0;
    }
  }

  void addObject(TownClass town_class, const Eigen::Vector3d& position_m, double length_m = 0.0, double depth_m = 0.0) {
    TownObject object;
    object.town_class = town_class;
    object.position_m = position_m;
    object.length_m = length_m;
    object.depth_m = depth_m;
    landmarks_.push_back({object, {{0, kFrames - 1}}});
  }

  std::vector<SimulatedFrame> detect(const std::vector<Eigen::Vector3d>& moving = {}) const {
    const std::vector<std::vector<Eigen::Vector3d>> traffic(kFrames, moving);
    return simulateDetections(landmarks_, traffic, motion_, scenario_, indices_, Rng(1));
  }

  /// Detections of one landmark over all frames.
  std::vector<Detection> detectionsOf(int id, const std::vector<Eigen::Vector3d>& moving = {}) const {
    std::vector<Detection> found;
    for (const SimulatedFrame& frame : detect(moving)) {
      for (std::size_t i = 0; i < frame.truth_ids.size(); ++i) {
        if (frame.truth_ids[i] == id) found.push_back(frame.detections[i]);
      }
    }
    return found;
  }

  TownClassConfig& pole() { return scenario_.classes[TownClass::kPole]; }
  ClassIndex indexOf(TownClass town_class) const { return indices_[static_cast<std::size_t>(town_class)]; }

  std::array<ClassIndex, kTownClassCount> indices_;
  VehicleMotion motion_;
  Scenario scenario_;
  std::vector<ScheduledLandmark> landmarks_;
};

TEST_F(DetectorTest, WithoutErrorsSeesThingsWhereTheyAre) {
  addObject(TownClass::kPole, {10.0, 5.0, -0.5});
  const auto found = detectionsOf(0);
  ASSERT_GT(found.size(), 0.99 * kFrames);
  for (const Detection& detection : found) {
    EXPECT_EQ(detection.class_index, indexOf(TownClass::kPole));
    EXPECT_EQ(detection.position_m, Eigen::Vector3d(10.0, 5.0, -0.5));
  }
}

TEST_F(DetectorTest, NoiseHasTheConfiguredMeanAndDeviation) {
  addObject(TownClass::kPole, {0.0, 20.0, 0.0});  // line of sight along y, across it along x
  pole().range_stddev_m = 0.3;
  pole().lateral_stddev_m = 0.2;
  pole().height_noise_stddev_m = 0.1;
  pole().range_bias_m = -0.1;
  pole().range_bias_per_m = -0.01;
  pole().height_bias_per_m = 0.02;
  scenario_.detector.range_stddev_per_m = 0.02;
  const auto found = detectionsOf(0);
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();
  for (const Detection& detection : found) mean += detection.position_m / static_cast<double>(found.size());
  for (const Detection& detection : found) {
    squares += (detection.position_m - mean).cwiseAbs2() / static_cast<double>(found.size());
  }
  const Eigen::Vector3d stddev(0.2, 0.5, 0.1);
  const Eigen::Vector3d expected(0.0, 19.7, 0.4);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(mean[axis], expected[axis], 4.0 * stddev[axis] / std::sqrt(kFrames));
    EXPECT_NEAR(std::sqrt(squares[axis]), stddev[axis], 4.0 * stddev[axis] / std::sqrt(2.0 * kFrames));
  }
}

TEST_F(DetectorTest, HalfOfTheChanceIsLeftAtTheHalfRange) {
  addObject(TownClass::kPole, {30.0, 0.0, 0.0});
  pole().detection_prob = 0.8;
  pole().half_range_m = 30.0;
  EXPECT_NEAR(static_cast<double>(detectionsOf(0).size()), 0.4 * kFrames, 4.0 * std::sqrt(0.24 * kFrames));
}

TEST_F(DetectorTest, SeesNothingBeyondItsRangeOrField) {
  scenario_.detector.max_range_m = 20.0;
  scenario_.detector.field_of_view_rad = 1.6;
  addObject(TownClass::kPole, {20.1, 0.0, 0.0});
  addObject(TownClass::kPole, {0.0, 10.0, 0.0});
  addObject(TownClass::kPole, {10.0, 9.0, 0.0});
  EXPECT_EQ(detectionsOf(0).size(), 0u);
  EXPECT_EQ(detectionsOf(1).size(), 0u);
  EXPECT_GT(detectionsOf(2).size(), 0.99 * kFrames);
}

TEST_F(DetectorTest, ABuildingHidesWhatStandsBehindIt) {
  addObject(TownClass::kBuilding, {0.0, 15.0, 1.0}, 10.0, 8.0);
  addObject(TownClass::kPole, {0.0, 25.0, 0.0});
  addObject(TownClass::kPole, {0.0, 8.0, 0.0});
  addObject(TownClass::kPole, {20.0, 20.0, 0.0});
  const std::vector<Eigen::Vector3d> moving = {{1.0, 25.0, 0.0}};
  EXPECT_GT(detectionsOf(0).size(), 0.99 * kFrames);
  EXPECT_EQ(detectionsOf(1).size(), 0u);
  EXPECT_GT(detectionsOf(2).size(), 0.99 * kFrames);
  EXPECT_GT(detectionsOf(3).size(), 0.99 * kFrames);
  EXPECT_EQ(detectionsOf(kMovingId, moving).size(), 0u);
  scenario_.detector.buildings_block_view = false;
  EXPECT_GT(detectionsOf(1).size(), 0.99 * kFrames);
  EXPECT_GT(detectionsOf(kMovingId, moving).size(), 0.99 * kFrames);
}

TEST_F(DetectorTest, AHiddenObjectIsHiddenForAWholePass) {
  for (int i = 0; i < 400; ++i) {
    addObject(TownClass::kPole, {10.0, 0.01 * i, 0.0});
    landmarks_.back().passes = {{0, 99}, {500, 599}};
  }
  motion_.T_world_base.resize(600);
  scenario_.detector.hidden_pass_prob = 0.3;
  std::map<std::pair<int, int>, int> seen;  // by landmark and pass
  const auto frames = detect();
  for (int k = 0; k < static_cast<int>(frames.size()); ++k) {
    for (const int id : frames[static_cast<std::size_t>(k)].truth_ids) ++seen[{id, k / 500}];
  }
  int hidden = 0;
  for (int id = 0; id < 400; ++id) {
    for (int pass = 0; pass < 2; ++pass) {
      const int count = seen[{id, pass}];
      if (count == 0) ++hidden;
      EXPECT_TRUE(count == 0 || count > 90) << count << ": hidden during a part of a pass";
    }
  }
  EXPECT_NEAR(hidden, 240, 4.0 * std::sqrt(800 * 0.21));
}

TEST_F(DetectorTest, ClutterHasThePoissonMeanAndVariance) {
  scenario_.detector.clutter_mean = 2.5;
  double sum = 0.0;
  double squares = 0.0;
  for (const SimulatedFrame& frame : detect()) {
    const double count = static_cast<double>(frame.truth_ids.size());
    EXPECT_EQ(std::count(frame.truth_ids.begin(), frame.truth_ids.end(), kClutterId), count);
    sum += count;
    squares += (count - 2.5) * (count - 2.5);
  }
  EXPECT_NEAR(sum / kFrames, 2.5, 4.0 * std::sqrt(2.5 / kFrames));
  EXPECT_NEAR(squares / kFrames, 2.5, 0.45);
}

TEST_F(DetectorTest, FramesAreMissedAtTheConfiguredRate) {
  addObject(TownClass::kPole, {5.0, 0.0, 0.0});
  scenario_.classes[TownClass::kPole].half_range_m = 200.0;
  scenario_.detector.range_falloff_m = 1.0;  // every other chance to miss is below 1e-80
  scenario_.detector.missed_frame_prob = 0.1;
  const auto frames = detect();
  const auto empty = [](const SimulatedFrame& frame) { return frame.detections.empty(); };
  EXPECT_NEAR(static_cast<double>(std::count_if(frames.begin(), frames.end(), empty)), 0.1 * kFrames,
              4.0 * std::sqrt(0.09 * kFrames));
}

TEST_F(DetectorTest, ConfusesSimilarClassesAtTheConfiguredRateButNoVehicle) {
  addObject(TownClass::kPole, {5.0, 0.0, 0.0});
  addObject(TownClass::kVehicle, {5.0, 5.0, 0.0});
  scenario_.detector.confusion_prob = 0.2;
  std::map<ClassIndex, int> labels;
  for (const Detection& detection : detectionsOf(0)) ++labels[detection.class_index];
  EXPECT_NEAR(labels[indexOf(TownClass::kPole)], 0.8 * kFrames, 4.0 * std::sqrt(0.16 * kFrames));
  EXPECT_NEAR(labels[indexOf(TownClass::kTrunk)], 0.1 * kFrames, 4.0 * std::sqrt(0.09 * kFrames));
  EXPECT_NEAR(labels[indexOf(TownClass::kTrafficSign)], 0.1 * kFrames, 4.0 * std::sqrt(0.09 * kFrames));
  for (const Detection& detection : detectionsOf(1)) {
    EXPECT_EQ(detection.class_index, indexOf(TownClass::kVehicle));
  }
}

TEST_F(DetectorTest, ASplitObjectGivesTwoPartsAroundIt) {
  addObject(TownClass::kPole, {5.0, 0.0, 0.0});
  scenario_.detector.split_prob = 1.0;
  for (const SimulatedFrame& frame : detect()) {
    if (frame.detections.empty()) continue;
    ASSERT_EQ(frame.truth_ids, std::vector<int>({0, 0}));
    const Eigen::Vector3d a = frame.detections[0].position_m;
    const Eigen::Vector3d b = frame.detections[1].position_m;
    EXPECT_LT((0.5 * (a + b) - Eigen::Vector3d(5.0, 0.0, 0.0)).norm(), 0.002);
    EXPECT_LE((a - b).norm(), scenario_.detector.split_distance_m + 0.002);
  }
}

TEST_F(DetectorTest, PositionsAreWholeMillimetresAndTheOrderSaysNothing) {
  for (int i = 0; i < 10; ++i) addObject(TownClass::kPole, {10.0, i - 5.0, 0.0});
  pole().range_stddev_m = 0.1;
  int first_is_first = 0;
  for (const SimulatedFrame& frame : detect()) {
    first_is_first += !frame.truth_ids.empty() && frame.truth_ids[0] == 0;
    for (const Detection& detection : frame.detections) {
      for (int axis = 0; axis < 3; ++axis) {
        const double value = detection.position_m[axis];
        EXPECT_EQ(value, std::round(value * 1000.0) / 1000.0);
        EXPECT_FALSE(value == 0.0 && std::signbit(value));
      }
    }
  }
  EXPECT_NEAR(first_is_first, 0.1 * kFrames, 4.0 * std::sqrt(0.09 * kFrames));
}

TEST_F(DetectorTest, AnotherObjectLeavesTheFirstAsItWas) {
  pole().range_stddev_m = 0.1;
  addObject(TownClass::kPole, {10.0, 0.0, 0.0});
  const auto alone = detectionsOf(0);
  addObject(TownClass::kPole, {0.0, 10.0, 0.0});
  const auto together = detectionsOf(0);
  ASSERT_EQ(alone.size(), together.size());
  for (std::size_t i = 0; i < alone.size(); ++i) EXPECT_EQ(alone[i].position_m, together[i].position_m);
}

TEST(TownClassIndicesTest, NamesTheClassesThatTheTableLacks) {
  std::vector<ClassInfo> classes = simulationClasses().all();
  classes.erase(std::remove_if(classes.begin(), classes.end(),
                               [](const ClassInfo& info) { return info.name == "fence" || info.name == "trunk"; }),
                classes.end());
  try {
    townClassIndices(ClassTable(classes, "test"));
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("fence, trunk"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace semantic_mht_slam
