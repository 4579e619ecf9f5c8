/// \file
/// Runs over simulated drives with positions by satellites.

#include <gtest/gtest.h>

#include "semantic_mht_slam/app/landmark_files.h"
#include "semantic_mht_slam/app/offline_runner.h"
#include "semantic_mht_slam/app/result_files.h"
#include "semantic_mht_slam/io/text_file.h"

#include "support/simulated_fixes.h"
#include "support/simulated_rounds.h"
#include "support/temporary_folder.h"

namespace semantic_mht_slam {
namespace {

/// A drive that never comes back to where it was, with an odometry that drifts.
class GnssRunnerTest : public ::testing::Test {
 protected:
  static SimulatedDrive driftingDrive(const ClassTable& classes) {
    const Scenario scenario = loadScenario(
        packageConfigFile("scenarios/town.yaml"),
        {"route.length=1500", "route.same_direction_fraction=0", "route.opposite_direction_fraction=0",
         "network.columns=12", "network.rows=10", "odometry.heading_bias=0.003", "odometry.heading_noise=0.008",
         "odometry.scale_stddev=0.02", "odometry.scale_variation_stddev=0.02", "detector.max_range=15"});
    return simulateDrive(scenario, classes, 6);
  }

  RunResult run(const std::vector<GnssFix>& fixes) const {
    Recording recording = toRecording(drive_);
    recording.fixes = fixes;
    return runOffline(recording, config_.slam, classes_, [](std::size_t, std::size_t) {});
  }

  double error_m(const RunResult& result) const {
    Recording truth;
    for (std::size_t i = 0; i < drive_.stamps.size(); ++i) {
      truth.ground_truth.push_back({drive_.stamps[i], drive_.T_map_base[i]});
    }
    return scoreRun(truth, result.trajectory)->se3_m;
  }

  const SystemConfig config_ = makeSystemConfig({});
  const ClassTable classes_ = loadClassTable(config_, "");
  const SimulatedDrive drive_ = driftingDrive(classes_);
};

TEST_F(GnssRunnerTest, FixesTakeAwayTheDriftAndOutliersDoNotMatter) {
  const double without_m = error_m(run({}));
  SimulatedReceiver receiver;
  const RunResult good = run(simulateFixes(drive_, receiver, 3));
  const double with_m = error_m(good);
  EXPECT_LT(with_m, 0.5 * without_m);
  EXPECT_LT(with_m, 2.0 * receiver.stddev_m);
  receiver.outlier_prob = 0.1;
  const RunResult bad = run(simulateFixes(drive_, receiver, 3));
  EXPECT_LT(error_m(bad), 1.25 * with_m + 0.1);
  RecordProperty("without_mm", static_cast<int>(1e3 * without_m));
  RecordProperty("with_mm", static_cast<int>(1e3 * with_m));
  RecordProperty("outliers_mm", static_cast<int>(1e3 * error_m(bad)));
  ASSERT_TRUE(good.geo_reference);
  const MapOrigin origin = originOf(*good.geo_reference);
  const Eigen::Vector2d end_deg = toLatitudeLongitude(origin, good.trajectory.back().T_world_base.translation_m);
  const Eigen::Vector3d end_m = toEastNorthUp(receiver.origin, {end_deg.x(), end_deg.y(), receiver.origin.altitude_m});
  const Eigen::Vector3d truth_m = receiver.T_enu_map * drive_.T_map_base.back().translation_m;
  EXPECT_LT((end_m - truth_m).head<2>().norm(), 5.0 * receiver.stddev_m);
}

TEST_F(GnssRunnerTest, OfAReceiverThatNeverHadAFixNothingChangesAndTheReportSaysWhy) {
  std::vector<GnssFix> fixes = simulateFixes(drive_, {}, 3);
  for (GnssFix& fix : fixes) fix.has_fix = false;
  const RunResult without = run({});
  const RunResult nothing = run(fixes);
  ASSERT_EQ(without.trajectory.size(), nothing.trajectory.size());
  for (std::size_t i = 0; i < without.trajectory.size(); ++i) {
    ASSERT_EQ(without.trajectory[i].T_world_base.matrix(), nothing.trajectory[i].T_world_base.matrix()) << i;
  }
  const TemporaryFolder folder;
  Recording recording = toRecording(drive_);
  writeReport(folder.path(), recording, without, std::nullopt, config_, 0);
  EXPECT_EQ(readFile(folder / "report.json").find("fixes"), std::string::npos);
  writeReport(folder.path(), recording, nothing, std::nullopt, config_, 0);
  const std::string report = readFile(folder / "report.json");
  EXPECT_NE(report.find("\"no_fix\": " + std::to_string(fixes.size())), std::string::npos) << report;
  EXPECT_NE(report.find("\"is_map_placed\": false"), std::string::npos) << report;
}

}  // namespace
}  // namespace semantic_mht_slam
