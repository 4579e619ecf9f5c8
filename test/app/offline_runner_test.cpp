#include "semantic_mht_slam/app/offline_runner.h"

#include <cmath>

#include <gtest/gtest.h>

#include "semantic_mht_slam/app/result_files.h"
#include "semantic_mht_slam/io/dataset.h"
#include "semantic_mht_slam/io/text_file.h"
#include "semantic_mht_slam/io/trajectory_file.h"
#include "semantic_mht_slam/io/yaml_file.h"

#include "support/expect_input_error.h"
#include "support/recordings.h"
#include "support/temporary_folder.h"

namespace semantic_mht_slam {
namespace {

RunResult run(const Recording& recording, const ClassTable& classes = makeTwoClasses()) {
  return runOffline(recording, defaultsOf(Method::kOdometry), classes, [](std::size_t, std::size_t) {});
}

TEST(OfflineRunnerTest, EveryFrameAndDetectionGoesThroughOnce) {
  const Recording recording = makeCircleRecording(41);
  std::size_t detections = 0;
  for (const DetectorFrame& frame : recording.detector_frames) detections += frame.detections.size();
  std::size_t calls = 0;
  const RunResult result =
      runOffline(recording, SlamConfig{}, makeTwoClasses(), [&](std::size_t done, std::size_t all) {
        EXPECT_EQ(done, ++calls);
        EXPECT_EQ(all, 41U);
      });
  EXPECT_EQ(calls, 41U);
  EXPECT_EQ(result.trajectory.size(), 41U);
  ASSERT_EQ(result.step_ms.size(), 41U);
  ASSERT_EQ(result.mapping_ms.size(), 41U);
  double mapping_ms = 0.0;
  for (std::size_t i = 0; i < 41; ++i) {
    EXPECT_LE(result.mapping_ms[i], result.step_ms[i]) << "step " << i;
    mapping_ms += result.mapping_ms[i];
  }
  EXPECT_GT(mapping_ms, 0.0);
  EXPECT_EQ(result.counters.frames, 41U);
  EXPECT_EQ(result.counters.detections, detections);
}

TEST(OfflineRunnerTest, ALongStandstillHasItsRowsThoughTheMapDoesNotKeepThem) {
  Recording recording = makeCircleRecording(41);
  const DetectorFrame seen = recording.detector_frames.back();
  const StampedPose stand = recording.odometry.back();
  for (int i = 1; i <= 500; ++i) {
    recording.odometry.push_back({stand.stamp + i * 100000000LL, stand.T_world_base});
    recording.detector_frames.push_back(seen);
    recording.detector_frames.back().stamp = recording.odometry.back().stamp;
  }
  const RunResult result = runOffline(recording, SlamConfig{}, makeTwoClasses(), [](std::size_t, std::size_t) {});
  ASSERT_EQ(result.trajectory.size(), 541U);
  EXPECT_EQ(result.trajectory_cov.size(), 541U);
  EXPECT_EQ(result.online_trajectory.size(), 541U);
  EXPECT_LT(result.whole_trajectory.size(), 345U);
  for (std::size_t i = 0; i < 541; ++i) {
    ASSERT_EQ(result.trajectory[i].stamp, recording.odometry[i].stamp);
    if (i < 41) continue;
    EXPECT_LT(
        (result.trajectory[i].T_world_base.translation_m - result.trajectory[40].T_world_base.translation_m).norm(),
        1e-6);
  }
}

TEST(OfflineRunnerTest, EverySampleHasItsRowThoughTheOdometryWasSetToZero) {
  Recording recording = makeCircleRecording(200);
  const Pose T_before = recording.odometry[120].T_world_base;
  for (std::size_t i = 120; i < 200; ++i) {
    recording.odometry[i].T_world_base = T_before.inverse() * recording.odometry[i].T_world_base;
  }
  const RunResult result = runOffline(recording, SlamConfig{}, makeTwoClasses(), [](std::size_t, std::size_t) {});
  EXPECT_EQ(result.sessions.size(), 2U);
  ASSERT_EQ(result.online_trajectory.size(), 200U);
  EXPECT_EQ(result.online_trajectory_cov.size(), 200U);
  EXPECT_EQ(result.trajectory.size(), 200U);
  EXPECT_EQ(result.trajectory_cov.size(), 200U);
  for (std::size_t i = 0; i < 200; ++i) EXPECT_EQ(result.online_trajectory[i].stamp, recording.odometry[i].stamp);
}

TEST(OfflineRunnerTest, ARecordingWithoutUsableOdometryIsRefused) {
  Recording recording = makeCircleRecording(3);
  for (StampedPose& pose : recording.odometry) pose.T_world_base.translation_m.x() = std::nan("");
  expectInputError([&] { run(recording); }, {"odometry"});
}

TEST(OfflineRunnerTest, ScoreIsTheOffsetOfTheGroundTruth) {
  const Recording recording = makeCircleRecording(200);
  const auto error = scoreRun(recording, run(recording).trajectory);
  ASSERT_TRUE(error);
  EXPECT_NEAR(error->first_m, 0.0, 1e-9) << "a constant offset vanishes when the first poses are made equal";
  EXPECT_NEAR(error->se3_m, 0.0, 1e-9);
  Recording without_truth = recording;
  without_truth.ground_truth.clear();
  EXPECT_FALSE(scoreRun(without_truth, run(without_truth).trajectory));
}

TEST(OfflineRunnerTest, ResultsHaveTheRowsAndTheFrameOfTheOdometryFile) {
  const Recording recording = makeCircleRecording(30);
  const TemporaryFolder folder;
  const RunResult result = run(recording);
  writeResultFiles(folder.path(), recording, result, SystemConfig{}, makeTwoClasses());
  const std::vector<Pose> in_camera = readKittiTrajectory(folder / "trajectory.txt");
  ASSERT_EQ(in_camera.size(), 30U);
  for (std::size_t i = 0; i < in_camera.size(); ++i) {
    const Pose T_odom_base = toBase(in_camera[i], recording.T_base_cam0->inverse());
    EXPECT_LT((T_odom_base.matrix() - recording.odometry[i].T_world_base.matrix()).norm(), 1e-9);
  }
  EXPECT_EQ(readTumTrajectory(folder / "trajectory.tum").back().stamp, recording.odometry.back().stamp);
}

/// Figures of the data's own documentation: SE3-aligned error of the raw odometry in metres.
struct KittiCase {
  const char* sequence;
  const char* odometry;
  double running_m;
  double se3_m;
};

class KittiOdometryTest : public ::testing::TestWithParam<KittiCase> {};

TEST_P(KittiOdometryTest, ErrorsAgreeWithThePublishedTable) {
  const auto folder = kittiFolder(GetParam().sequence);
  if (!folder) GTEST_SKIP() << "SEMANTIC_MHT_SLAM_DATA is not set";
  const std::string objects = std::string(GetParam().sequence) == "00" ? "objects.csv" : "objects_semireal.csv";
  const ClassTable classes = readClassTable(packageConfigFile("classes_semantic_kitti.yaml"));
  const Recording recording =
      toRecording(readDataset({*folder, objects, std::string("odometry/") + GetParam().odometry + ".txt"}, classes));
  const auto error = scoreRun(recording, run(recording, classes).trajectory);
  ASSERT_TRUE(error);
  EXPECT_NEAR(error->running_mean_m, GetParam().running_m, 0.0051);
  EXPECT_NEAR(error->se3_m, GetParam().se3_m, 0.0051);
}

INSTANTIATE_TEST_SUITE_P(
    AllSequences, KittiOdometryTest,
    ::testing::Values(KittiCase{"00", "vo_orb", 6.76, 3.87}, KittiCase{"00", "vo_dfvo", 13.20, 11.34},
                      KittiCase{"00", "lo_simple", 5.62, 4.86}, KittiCase{"05", "vo_orb", 3.00, 2.06},
                      KittiCase{"05", "vo_dfvo", 4.92, 3.63}, KittiCase{"05", "lo_simple", 1.87, 2.29},
                      KittiCase{"06", "vo_orb", 1.94, 2.15}, KittiCase{"06", "vo_dfvo", 3.65, 2.53},
                      KittiCase{"06", "lo_simple", 1.59, 0.56}, KittiCase{"07", "vo_orb", 1.50, 1.50},
                      KittiCase{"07", "vo_dfvo", 2.06, 1.72}, KittiCase{"07", "lo_simple", 0.76, 0.78}),
    [](const auto& kitti) { return std::string(kitti.param.sequence) + "_" + kitti.param.odometry; });

}  // namespace
}  // namespace semantic_mht_slam
