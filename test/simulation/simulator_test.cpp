#include "semantic_mht_slam/simulation/simulator.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "semantic_mht_slam/common/error.h"

#include "scenario_files.h"

namespace semantic_mht_slam {
namespace {

bool identical(const Pose& a, const Pose& b) {
  return a.rotation.coeffs() == b.rotation.coeffs() && a.translation_m == b.translation_m;
}

bool identical(const std::vector<Pose>& a, const std::vector<Pose>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const Pose& x, const Pose& y) { return identical(x, y); });
}

bool identical(const Detections& a, const Detections& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Detection& x, const Detection& y) {
    return x.class_index == y.class_index && x.position_m == y.position_m;
  });
}

bool identical(const std::vector<SimulatedLandmark>& a, const std::vector<SimulatedLandmark>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const SimulatedLandmark& x, const SimulatedLandmark& y) {
    return x.id == y.id && x.class_index == y.class_index && x.position_m == y.position_m;
  });
}

SimulatedDrive simulate(const Scenario& scenario, std::uint64_t seed) {
  return simulateDrive(scenario, simulationClasses(), seed);
}

double headingDifference(const Pose& a, const Pose& b) {
  const Eigen::Vector3d forward = (a.inverse() * b).rotation * Eigen::Vector3d::UnitX();
  return std::abs(std::atan2(forward.y(), forward.x())) * 180.0 / 3.14159265358979;
}

struct Revisits {
  double same = 0.0;      ///< share of the frames at a place passed before in the same direction
  double opposite = 0.0;  ///< and in the opposite direction
};

Revisits revisitsOf(const SimulatedDrive& drive) {
  std::set<int> same;
  std::set<int> opposite;
  for (const auto& [i, j] : drive.loop_pairs) {
    const double difference =
        headingDifference(drive.T_map_base[static_cast<std::size_t>(i)], drive.T_map_base[static_cast<std::size_t>(j)]);
    if (difference < 30.0) same.insert(i);
    if (difference > 150.0) opposite.insert(i);
  }
  const double frames = static_cast<double>(drive.stamps.size());
  return {static_cast<double>(same.size()) / frames, static_cast<double>(opposite.size()) / frames};
}

TEST(SimulatorTest, SameSeedGivesTheSameBytes) {
  const Scenario scenario = shippedScenario("short");
  const SimulatedDrive a = simulate(scenario, 7);
  const SimulatedDrive b = simulate(scenario, 7);
  EXPECT_EQ(a.stamps, b.stamps);
  EXPECT_TRUE(identical(a.T_map_base, b.T_map_base));
  EXPECT_TRUE(identical(a.T_odom_base, b.T_odom_base));
  EXPECT_TRUE(identical(a.landmarks, b.landmarks));
  EXPECT_EQ(a.truth_ids, b.truth_ids);
  EXPECT_EQ(a.loop_pairs, b.loop_pairs);
  for (std::size_t k = 0; k < a.detections.size(); ++k) EXPECT_TRUE(identical(a.detections[k], b.detections[k]));
}

TEST(SimulatorTest, AnotherSeedGivesAnotherDrive) {
  const Scenario scenario = shippedScenario("short");
  const SimulatedDrive a = simulate(scenario, 7);
  const SimulatedDrive b = simulate(scenario, 8);
  EXPECT_FALSE(identical(a.T_map_base, b.T_map_base));
  EXPECT_FALSE(identical(a.T_odom_base, b.T_odom_base));
  EXPECT_FALSE(identical(a.landmarks, b.landmarks));
}

TEST(SimulatorTest, ADetectorLeavesTownRouteAndOdometryAsTheyAre) {
  Scenario scenario = shippedScenario("short");
  const SimulatedDrive a = simulate(scenario, 7);
  scenario.detector.clutter_mean = 3.0;
  scenario.detector.split_prob = 0.2;
  scenario.classes[TownClass::kPole].range_stddev_m = 0.5;
  const SimulatedDrive b = simulate(scenario, 7);
  EXPECT_TRUE(identical(a.T_map_base, b.T_map_base));
  EXPECT_TRUE(identical(a.T_odom_base, b.T_odom_base));
  EXPECT_TRUE(identical(a.landmarks, b.landmarks));
  EXPECT_FALSE(a.truth_ids == b.truth_ids);
}

TEST(SimulatorTest, OdometryLeavesTheDetectionsAsTheyAre) {
  Scenario scenario = shippedScenario("short");
  const SimulatedDrive a = simulate(scenario, 7);
  scenario.odometry.heading_noise_rad_per_sqrt_m = 0.01;
  const SimulatedDrive b = simulate(scenario, 7);
  EXPECT_EQ(a.truth_ids, b.truth_ids);
  EXPECT_FALSE(identical(a.T_odom_base, b.T_odom_base));
}

TEST(SimulatorTest, AllListsHaveOneEntryAFrameAndBeginAtTheOrigin) {
  const SimulatedDrive drive = simulate(shippedScenario("short"), 3);
  const std::size_t frames = drive.stamps.size();
  EXPECT_EQ(drive.T_map_base.size(), frames);
  EXPECT_EQ(drive.T_odom_base.size(), frames);
  EXPECT_EQ(drive.detections.size(), frames);
  EXPECT_EQ(drive.truth_ids.size(), frames);
  EXPECT_TRUE(identical(drive.T_map_base[0], Pose::identity()));
  EXPECT_TRUE(identical(drive.T_odom_base[0], Pose::identity()));
  EXPECT_EQ(drive.stamps[0], 0);
  for (std::size_t k = 0; k < frames; ++k) {
    EXPECT_TRUE(drive.T_map_base[k].isValid());
    EXPECT_TRUE(drive.T_odom_base[k].isValid());
  }
}

TEST(SimulatorTest, DetectionsKnowTheirPlaceInTheirFrame) {
  for (const Detections& frame : simulate(shippedScenario("short"), 3).detections) {
    for (std::size_t row = 0; row < frame.size(); ++row) EXPECT_EQ(frame[row].row, static_cast<int>(row));
  }
}

TEST(SimulatorTest, CameraAxesAreRightDownForward) {
  const Pose T_cam0_base = simulate(shippedScenario("short"), 3).T_cam0_base;
  EXPECT_EQ(T_cam0_base.rotation * Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitZ());
  EXPECT_EQ(T_cam0_base.rotation * Eigen::Vector3d::UnitY(), -Eigen::Vector3d::UnitX());
  EXPECT_EQ(T_cam0_base.rotation * Eigen::Vector3d::UnitZ(), -Eigen::Vector3d::UnitY());
}

TEST(SimulatorTest, EveryTruthIdNamesALandmarkNearItsDetection) {
  Scenario scenario = shippedScenario("short");
  scenario.detector.confusion_prob = 0.0;
  const SimulatedDrive drive = simulate(scenario, 3);
  const ClassIndex vehicle = *simulationClasses().findName("vehicle");
  int moving = 0;
  for (std::size_t k = 0; k < drive.detections.size(); ++k) {
    ASSERT_EQ(drive.detections[k].size(), drive.truth_ids[k].size());
    for (std::size_t i = 0; i < drive.detections[k].size(); ++i) {
      const int id = drive.truth_ids[k][i];
      const Detection& detection = drive.detections[k][i];
      ASSERT_GE(id, -2);
      ASSERT_LT(id, static_cast<int>(drive.landmarks.size()));
      EXPECT_TRUE(id != -2 || detection.class_index == vehicle);
      moving += id == -2;
      if (id < 0) continue;
      const SimulatedLandmark& landmark = drive.landmarks[static_cast<std::size_t>(id)];
      EXPECT_EQ(landmark.id, id);
      EXPECT_EQ(landmark.class_index, detection.class_index);
      // half a building, the noise and the bias
      EXPECT_LT((drive.T_map_base[k] * detection.position_m - landmark.position_m).norm(), 15.0);
    }
  }
  EXPECT_GT(moving, 0);
}

TEST(SimulatorTest, PolesAreDetectedWhereTheyStand) {
  const Scenario scenario = shippedScenario("short");
  const SimulatedDrive drive = simulate(scenario, 3);
  const ClassIndex pole = *simulationClasses().findName("pole");
  const TownClassConfig& config = scenario.classes[TownClass::kPole];
  double bias = 0.0;
  double across_squares = 0.0;
  int count = 0;
  for (std::size_t k = 0; k < drive.detections.size(); ++k) {
    for (std::size_t i = 0; i < drive.detections[k].size(); ++i) {
      const int id = drive.truth_ids[k][i];
      if (id < 0 || drive.landmarks[static_cast<std::size_t>(id)].class_index != pole) continue;
      const Eigen::Vector3d truth =
          drive.T_map_base[k].inverse() * drive.landmarks[static_cast<std::size_t>(id)].position_m;
      const Eigen::Vector3d error = drive.detections[k][i].position_m - truth;
      const Eigen::Vector3d across = Eigen::Vector3d(-truth.y(), truth.x(), 0.0).normalized();
      bias += error.z() - config.height_bias_per_m * truth.norm();
      across_squares += error.dot(across) * error.dot(across);
      ++count;
    }
  }
  ASSERT_GT(count, 1000);
  EXPECT_NEAR(bias / count, 0.0, 0.01);
  EXPECT_NEAR(std::sqrt(across_squares / count), config.lateral_stddev_m, 0.1 * config.lateral_stddev_m);
}

TEST(SimulatorTest, TheTownIsRevisitedInBothDirections) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Revisits revisits = revisitsOf(simulate(shippedScenario("town"), seed));
    EXPECT_GT(revisits.same, 0.08) << "seed " << seed;
    EXPECT_GT(revisits.opposite, 0.05) << "seed " << seed;
    EXPECT_LT(revisits.same + revisits.opposite, 0.6) << "seed " << seed;
  }
}

TEST(SimulatorTest, TheOppositeDirectionScenarioHasHardlyOtherLoops) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Revisits revisits = revisitsOf(simulate(shippedScenario("opposite_direction"), seed));
    EXPECT_GT(revisits.opposite, 0.15) << "seed " << seed;
    EXPECT_LT(revisits.same, 0.1) << "seed " << seed;
  }
}

TEST(SimulatorTest, LoopPairsEqualBruteForceAndNeedADriveBetween) {
  const SimulatedDrive drive = simulate(shippedScenario("short"), 3);
  std::vector<std::pair<int, int>> expected;
  for (int i = 0; i < static_cast<int>(drive.T_map_base.size()); ++i) {
    for (int j = 0; j + 50 < i; ++j) {
      const Eigen::Vector3d difference = drive.T_map_base[static_cast<std::size_t>(i)].translation_m -
                                         drive.T_map_base[static_cast<std::size_t>(j)].translation_m;
      if (difference.head<2>().norm() < 3.0) expected.emplace_back(i, j);
    }
  }
  EXPECT_EQ(drive.loop_pairs, expected);
  EXPECT_FALSE(expected.empty());
}

TEST(SimulatorTest, ImpossibleScenariosNameTheField) {
  Scenario scenario;
  scenario.route.length_m = 90000.0;
  try {
    simulate(scenario, 1);
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("route.length"), std::string::npos) << error.what();
  }
  scenario = Scenario();
  scenario.network.rows = 1;
  EXPECT_THROW(simulate(scenario, 1), ConfigError);
  EXPECT_THROW(simulateDrive(Scenario(), ClassTable(), 1), InputError);
}

}  // namespace
}  // namespace semantic_mht_slam
