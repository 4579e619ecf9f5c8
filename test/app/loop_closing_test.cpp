#include <gtest/gtest.h>

#include "semantic_mht_slam/app/offline_runner.h"
#include "semantic_mht_slam/app/result_files.h"
#include "semantic_mht_slam/app/system_config.h"
#include "semantic_mht_slam/io/dataset.h"
#include "semantic_mht_slam/io/trajectory_file.h"
#include "semantic_mht_slam/io/yaml_file.h"
#include "semantic_mht_slam/simulation/simulator.h"

#include "support/recordings.h"
#include "support/temporary_folder.h"

namespace semantic_mht_slam {
namespace {

const ClassTable& kittiClasses() {
  static const ClassTable kTable = readClassTable(packageConfigFile("classes_semantic_kitti.yaml"));
  return kTable;
}

SimulatedDrive simulate(const std::string& scenario_file, double length_m, std::uint64_t seed) {
  Scenario scenario;
  Fields fields;
  describe(scenario, fields);
  std::vector<Setting> settings = readSettings(packageConfigFile("scenarios/" + scenario_file));
  settings.push_back({"route.length", std::to_string(length_m), "test"});
  applySettings(settings, fields);
  return simulateDrive(scenario, kittiClasses(), seed);
}

Recording toRecording(const SimulatedDrive& drive) {
  Recording recording;
  recording.T_base_cam0 = drive.T_cam0_base.inverse();
  for (std::size_t i = 0; i < drive.stamps.size(); ++i) {
    recording.odometry.push_back({drive.stamps[i], drive.T_odom_base[i]});
    recording.ground_truth.push_back({drive.stamps[i], drive.T_map_base[i]});
    recording.detector_frames.push_back({drive.stamps[i], drive.detections[i]});
    Detections& detections = recording.detector_frames.back().detections;
    for (std::size_t row = 0; row < detections.size(); ++row) detections[row].row = static_cast<int>(row);
  }
  return recording;
}

RunResult run(const Recording& recording, const SlamConfig& config) {
  return runOffline(recording, config, kittiClasses(), [](std::size_t, std::size_t) {});
}

double se3Error(const Recording& recording, const std::vector<StampedPose>& trajectory) {
  return scoreRun(recording, trajectory)->se3_m;
}

class LoopClosingTest : public ::testing::TestWithParam<std::uint64_t> {
 protected:
  const SimulatedDrive drive_ = simulate("town.yaml", 1500.0, GetParam());
  const Recording recording_ = toRecording(drive_);
  const RunResult result_ = run(recording_, defaultsOf(Method::kDpmhm));
};

TEST_P(LoopClosingTest, TheErrorOfTheOdometryShrinks) {
  const double raw_m = se3Error(recording_, run(recording_, defaultsOf(Method::kOdometry)).trajectory);
  EXPECT_LT(se3Error(recording_, result_.trajectory), 0.6 * raw_m);
  ASSERT_EQ(result_.online_trajectory.size(), result_.trajectory.size());
  EXPECT_LT(se3Error(recording_, result_.online_trajectory), 1.02 * raw_m);
}

TEST_P(LoopClosingTest, AcceptedClosuresAreTrue) {
  std::size_t accepted = 0;
  for (const LoopClosureResult& closure : result_.loop_closures) {
    if (!closure.record.is_accepted) continue;
    ++accepted;
    const Pose T_match_query =
        drive_.T_map_base[closure.match_frame].inverse() * drive_.T_map_base[closure.query_frame];
    EXPECT_LT((T_match_query.translation_m - closure.record.T_match_query.translation_m).norm(), 1.0);
  }
  EXPECT_GT(accepted, 3U);
}

/// Share of the detections of static landmarks, both passes together, that is in one landmark of the map.
double shareInOneLandmark(const SimulatedDrive& drive, const std::vector<DetectionAssociation>& associations) {
  std::map<int, std::map<LandmarkId, int>> ids_of;
  int static_detections = 0;
  for (const DetectionAssociation& association : associations) {
    const int truth = drive.truth_ids[association.frame][static_cast<std::size_t>(association.row)];
    if (truth < 0 || association.landmark == kNoLandmark) continue;
    const ClassIndex class_index = drive.landmarks[static_cast<std::size_t>(truth)].class_index;
    if (kittiClasses()[class_index].transition != Transition::kDirac) continue;
    ++ids_of[truth][association.landmark];
    ++static_detections;
  }
  int with_largest = 0;
  for (const auto& [truth, ids] : ids_of) {
    int largest = 0;
    for (const auto& [id, count] : ids) largest = std::max(largest, count);
    with_largest += largest;
  }
  return static_cast<double>(with_largest) / static_detections;
}

TEST_P(LoopClosingTest, LandmarksOfBothPassesBecomeOne) {
  EXPECT_GT(shareInOneLandmark(drive_, result_.associations), 0.9);
}

TEST_P(LoopClosingTest, SwitchedOffNothingTiesThePassesTogether) {
  SlamConfig config = defaultsOf(Method::kDpmhm);
  config.back_end.close_loops = false;
  const RunResult open = run(recording_, config);
  EXPECT_TRUE(open.loop_closures.empty());
  EXPECT_LT(shareInOneLandmark(drive_, open.associations), shareInOneLandmark(drive_, result_.associations) - 0.1);
  EXPECT_GT(se3Error(recording_, open.trajectory), 1.5 * se3Error(recording_, result_.trajectory));
}

TEST_P(LoopClosingTest, TheSameInputGivesTheSameBytes) {
  const RunResult again = run(recording_, defaultsOf(Method::kDpmhm));
  EXPECT_EQ(formatTumTrajectory(again.trajectory), formatTumTrajectory(result_.trajectory));
  EXPECT_EQ(formatTumTrajectory(again.online_trajectory), formatTumTrajectory(result_.online_trajectory));
  EXPECT_EQ(again.loop_closures.size(), result_.loop_closures.size());
}

INSTANTIATE_TEST_SUITE_P(Seeds, LoopClosingTest, ::testing::Values(21, 22));

/// SE3-aligned error in metres that a run with the package's configuration has to reach.
struct KittiBar {
  const char* sequence;
  const char* odometry;
  double bar_m;
};

class KittiSlamTest : public ::testing::TestWithParam<KittiBar> {};

TEST_P(KittiSlamTest, TheErrorIsBelowTheBarAndNoClosureIsWrong) {
  const auto folder = kittiFolder(GetParam().sequence);
  if (!folder) GTEST_SKIP() << "SEMANTIC_MHT_SLAM_DATA is not set";
  const std::string objects = std::string(GetParam().sequence) == "00" ? "objects.csv" : "objects_semireal.csv";
  const Recording recording = toRecording(
      readDataset({*folder, objects, std::string("odometry/") + GetParam().odometry + ".txt"}, kittiClasses()));
  const SystemConfig config = loadSystemConfig(packageConfigFile("kitti.yaml"), {});
  const RunResult result = run(recording, loadableSlamConfig(config, ""));
  EXPECT_LT(se3Error(recording, result.trajectory), GetParam().bar_m);
  for (const LoopClosureResult& closure : result.loop_closures) {
    if (!closure.record.is_accepted) continue;
    const Pose& T_map_query = recording.ground_truth[closure.query_frame].T_world_base;
    const Pose& T_map_match = recording.ground_truth[closure.match_frame].T_world_base;
    const Pose T_match_query = T_map_match.inverse() * T_map_query;
    // The ground truth of 00 contradicts itself between passes, across streets by more than 2 m: with objects that
    // agree with it (objects_semireal.csv) the same closures are off by 0.5 m at most.
    const bool is_contradicted = std::string(GetParam().sequence) == "00" && T_match_query.translation_m.norm() > 5.0;
    EXPECT_LT((T_match_query.translation_m - closure.record.T_match_query.translation_m).norm(),
              is_contradicted ? 3.5 : 2.0)
        << "frames " << closure.query_frame << " and " << closure.match_frame;
  }
}

INSTANTIATE_TEST_SUITE_P(AllSequences, KittiSlamTest,
                         ::testing::Values(KittiBar{"00", "vo_orb", 1.3}, KittiBar{"00", "vo_dfvo", 1.8},
                                           KittiBar{"05", "vo_orb", 0.5}, KittiBar{"05", "lo_simple", 0.4},
                                           KittiBar{"05", "vo_dfvo", 1.0}, KittiBar{"06", "vo_orb", 0.45},
                                           KittiBar{"06", "lo_simple", 0.22}, KittiBar{"06", "vo_dfvo", 0.6},
                                           KittiBar{"07", "vo_orb", 0.42}, KittiBar{"07", "lo_simple", 0.5},
                                           KittiBar{"07", "vo_dfvo", 0.6}),
                         [](const ::testing::TestParamInfo<KittiBar>& tested) {
                           return std::string("Sequence") + tested.param.sequence + "With" + tested.param.odometry;
                         });

}  // namespace
}  // namespace semantic_mht_slam
