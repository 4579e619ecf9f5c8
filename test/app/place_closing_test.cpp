#include <algorithm>
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "semantic_mht_slam/app/offline_runner.h"
#include "semantic_mht_slam/app/system_config.h"
#include "semantic_mht_slam/evaluation/loop_score.h"
#include "semantic_mht_slam/io/yaml_file.h"
#include "semantic_mht_slam/simulation/simulator.h"

namespace semantic_mht_slam {
namespace {

const ClassTable& classes() {
  static const ClassTable kTable = readClassTable(packageConfigFile("classes_semantic_kitti.yaml"));
  return kTable;
}

SimulatedDrive simulate(const std::string& scenario, double length_m, std::uint64_t seed) {
  Scenario config;
  Fields fields;
  describe(config, fields);
  std::vector<Setting> settings = readSettings(packageConfigFile("scenarios/" + scenario + ".yaml"));
  settings.push_back({"route.length", std::to_string(length_m), "test"});
  applySettings(settings, fields);
  return simulateDrive(config, classes(), seed);
}

/// The whole system on a drive.
RunResult run(const SimulatedDrive& drive, SlamConfig config = defaultsOf(Method::kDpmhm)) {
  Recording recording;
  for (std::size_t i = 0; i < drive.stamps.size(); ++i) {
    recording.odometry.push_back({drive.stamps[i], drive.T_odom_base[i]});
    recording.detector_frames.push_back({drive.stamps[i], drive.detections[i]});
  }
  config.mapper.tree.max_hypotheses = 10;  // speed; places do not depend on it
  return runOffline(recording, config, classes(), [](std::size_t, std::size_t) {});
}

ClosureScore scoreOf(const SimulatedDrive& drive, const RunResult& result) {
  std::vector<ClosureEstimate> closures;
  for (const auto& [query_frame, match_frame, record] : result.loop_closures) {
    closures.push_back({static_cast<std::int64_t>(query_frame), static_cast<std::int64_t>(match_frame),
                        record.is_accepted, record.T_match_query.translation_m});
  }
  return closureScore(drive.T_map_base, closures);
}

/// The drive with only those detections that pass.
SimulatedDrive filtered(SimulatedDrive drive, const std::function<bool(const Detection&)>& passes) {
  for (Detections& detections : drive.detections) {
    detections.erase(std::remove_if(detections.begin(), detections.end(),
                                    [&](const Detection& detection) { return !passes(detection); }),
                     detections.end());
  }
  return drive;
}

std::size_t acceptedPlaces(const RunResult& result) {
  return static_cast<std::size_t>(
      std::count_if(result.loop_closures.begin(), result.loop_closures.end(), [](const LoopClosureResult& closure) {
        return closure.record.is_accepted && closure.record.source == ClosureSource::kPlace;
      }));
}

/// There and back past one row of poles and trunks, with odometry that turns away slowly.
SimulatedDrive driveAlongARow(double spacing_m, double jitter_m, std::uint64_t seed) {
  constexpr int kFramesOneWay = 150;
  Rng rng(seed);
  std::vector<std::pair<Eigen::Vector3d, ClassIndex>> row;
  for (double x_m = -20.0; x_m < kFramesOneWay + 20.0; x_m += spacing_m) {
    const ClassIndex index = *classes().findName(rng.bernoulli(0.5) ? "pole" : "trunk");
    row.emplace_back(Eigen::Vector3d(x_m + rng.normal(0.0, jitter_m), 6.0, 0.0), index);
  }
  SimulatedDrive drive;
  double heading_error_rad = 0.0;
  for (int i = 0; i < 2 * kFramesOneWay; ++i) {
    const bool is_back = i >= kFramesOneWay;
    const double x_m = is_back ? 2 * kFramesOneWay - i : i;
    const Pose T_map_base{expRotation({0.0, 0.0, is_back ? M_PI : 0.0}), {x_m, is_back ? 1.5 : 0.0, 0.0}};
    heading_error_rad += rng.normal(0.0, 0.0005);
    drive.stamps.push_back(100000000LL * i);
    const Pose step = drive.T_map_base.empty() ? Pose::identity() : drive.T_map_base.back().inverse() * T_map_base;
    const Pose noise{expRotation({0.0, 0.0, heading_error_rad / 20.0}), {rng.normal(0.0, 0.01), 0.0, 0.0}};
    drive.T_odom_base.push_back(drive.T_odom_base.empty() ? step : drive.T_odom_base.back() * step * noise);
    drive.T_map_base.push_back(T_map_base);
    Detections detections;
    for (const auto& [position_m, index] : row) {
      Detection detection;
      detection.position_m = T_map_base.inverse() * position_m;
      for (int axis = 0; axis < 3; ++axis) detection.position_m(axis) += rng.normal(0.0, 0.05);
      detection.class_index = index;
      if (detection.position_m.norm() < 25.0) detections.push_back(detection);
    }
    drive.detections.push_back(detections);
  }
  return drive;
}

TEST(PlaceClosingTest, ClosesNothingWrongAmongIdenticalParallelStreets) {
  for (const std::uint64_t seed : {11U, 12U}) {
    const SimulatedDrive drive = simulate("parallel_streets", 900.0, seed);
    const ClosureScore score = scoreOf(drive, run(drive));
    EXPECT_EQ(score.wrong, 0) << "seed " << seed << ", " << score.accepted << " accepted";
  }
}

TEST(PlaceClosingTest, FindsTheWayBackInTheOppositeDirection) {
  const SimulatedDrive drive = simulate("opposite_direction", 2000.0, 13);
  const ClosureScore score = scoreOf(drive, run(drive));
  EXPECT_EQ(score.wrong, 0);
  ASSERT_GT(score.revisited_blocks, 0);
  EXPECT_GE(score.recall, 0.85);
}

TEST(PlaceClosingTest, ClosesNothingWithoutObjects) {
  const SimulatedDrive drive = filtered(simulate("town", 600.0, 14), [](const Detection&) { return false; });
  EXPECT_EQ(scoreOf(drive, run(drive)).accepted, 0);
}

TEST(PlaceClosingTest, ClosesNothingWrongWithASingleClassAndRecognisesNoPlaceByIt) {
  const ClassIndex pole = *classes().findName("pole");
  const SimulatedDrive drive = filtered(simulate("opposite_direction", 2000.0, 13),
                                        [&](const Detection& detection) { return detection.class_index == pole; });
  const RunResult result = run(drive);
  EXPECT_EQ(acceptedPlaces(result), 0U);
  EXPECT_EQ(scoreOf(drive, result).wrong, 0);
}

TEST(PlaceClosingTest, ClosesNothingWrongAlongASingleRowAndRecognisesNoPlaceByIt) {
  for (const double jitter_m : {0.0, 2.0}) {
    const SimulatedDrive drive = driveAlongARow(8.0, jitter_m, 15);
    const RunResult result = run(drive);
    EXPECT_EQ(acceptedPlaces(result), 0U) << "jitter " << jitter_m;
    EXPECT_EQ(scoreOf(drive, result).wrong, 0) << "jitter " << jitter_m;
  }
}

TEST(PlaceClosingTest, ThePapersChainGivesEveryScoreAndClosesNothingWrong) {
  const SimulatedDrive drive = simulate("opposite_direction", 2000.0, 13);
  SlamConfig config = defaultsOf(Method::kDpmhm);
  config.back_end.place.chain = PlaceChain::kPaper;
  config.back_end.revisit.enabled = false;
  config.mapper.alignment.enabled = false;
  const RunResult result = run(drive, config);
  EXPECT_EQ(scoreOf(drive, result).wrong, 0);
  ASSERT_FALSE(result.loop_closures.empty());
  for (const LoopClosureResult& closure : result.loop_closures) {
    EXPECT_GE(closure.record.place.histogram_divergence, 0.0);
    EXPECT_GE(closure.record.place.topology_score, -1.0);
    EXPECT_GE(closure.record.place.loop_prob, 0.0);
    EXPECT_EQ(closure.record.is_accepted, closure.record.reason.empty());
  }
}

TEST(PlaceClosingTest, SubmapsThatTheTreeSkipsAreNotSearchedAndAreTold) {
  const SimulatedDrive drive = filtered(simulate("opposite_direction", 2000.0, 13),
                                        [](const Detection& d) { return d.position_m.norm() < 8.0; });
  SystemConfig config;
  config.slam.back_end.evaluator.check_all = false;
  config.slam.mapper.submap.length_m = 30.0;  // as in the drives that the tree was made from
  config.slam.back_end.revisit.enabled = false;
  config.slam.mapper.alignment.enabled = false;
  const RunResult result = run(drive, loadableSlamConfig(config, ""));
  ASSERT_EQ(result.submap_checks.size(), result.submaps);
  const auto skipped = std::count_if(result.submap_checks.begin(), result.submap_checks.end(),
                                     [](const SubmapResult& submap) { return !submap.check.is_checked; });
  EXPECT_LT(skipped, static_cast<std::ptrdiff_t>(result.submaps)) << "the tree skips every submap";
  EXPECT_GT(skipped, 0) << "nothing to see";
  for (const LoopClosureResult& closure : result.loop_closures) {
    const auto next =
        std::upper_bound(result.submap_checks.begin(), result.submap_checks.end(), closure.query_frame,
                         [](std::size_t frame, const SubmapResult& submap) { return frame < submap.first_frame; });
    EXPECT_TRUE(std::prev(next)->check.is_checked) << "frame " << closure.query_frame;
  }
  for (const SubmapResult& submap : result.submap_checks) {
    EXPECT_EQ(submap.check.is_checked, submap.check.evaluation.worth_checking);
  }
}

}  // namespace
}  // namespace semantic_mht_slam
