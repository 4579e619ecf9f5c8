#include <algorithm>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "semantic_mht_slam/io/text_file.h"
#include "semantic_mht_slam/io/trajectory_file.h"

#include "support/run_program.h"
#include "support/temporary_folder.h"

namespace semantic_mht_slam {
namespace {

namespace fs = std::filesystem;

/// The programs on a short simulated drive, and on the same drive with one thing wrong.
class ProgramsTest : public ::testing::Test {
 protected:
  ProgramsTest() {
    const ProgramResult result =
        runProgramOfPackage("simulate_drive", "--scenario '" + std::string(SMHT_SOURCE_DIR) +
                                                  "/config/scenarios/short.yaml' --output '" + drive_ + "'");
    EXPECT_EQ(result.exit_code, 0) << result.output;
  }

  std::string offlineArguments() const {
    return "--dataset '" + drive_ + "' --odometry odometry/odometry.txt --output '" + output_ + "' ";
  }

  /// Expects exit code 1, one line that begins with the program's name and holds `part`, and no output folder.
  void expectRefused(const std::string& program, const std::string& arguments, const std::string& part) const {
    const ProgramResult result = runProgramOfPackage(program, arguments);
    EXPECT_EQ(result.exit_code, 1) << program << " " << arguments << "\n" << result.output;
    EXPECT_EQ(std::count(result.output.begin(), result.output.end(), '\n'), 1) << result.output;
    EXPECT_EQ(result.output.rfind(program + ": ", 0), 0U) << result.output;
    EXPECT_NE(result.output.find(part), std::string::npos) << result.output << "lacks: " << part;
    EXPECT_FALSE(fs::exists(output_)) << "something was written";
  }

  void replaceIn(const std::string& file, const std::string& content) const {
    writeFileAtomically(drive_ + "/" + file, content);
  }

  const TemporaryFolder folder_;
  const std::string drive_ = folder_ / "a drive";
  const std::string output_ = folder_ / "a result";
};

TEST_F(ProgramsTest, EachAnswersHelpWithCode0) {
  for (const char* program : {"slam_offline", "kitti_to_bag", "simulate_drive", "evaluate", "slam_node",
                              "extract_objects", "object_extractor_node", "segmentation_node"}) {
    const ProgramResult result = runProgramOfPackage(program, "--help");
    EXPECT_EQ(result.exit_code, 0) << program;
    EXPECT_NE(result.output.find(program), std::string::npos) << program;
  }
}

TEST_F(ProgramsTest, OfflineRunWritesEveryFileAndTwoRunsWriteTheSameBytes) {
  const std::string again = folder_ / "again";
  ASSERT_EQ(runProgramOfPackage("slam_offline", offlineArguments()).exit_code, 0);
  ASSERT_EQ(runProgramOfPackage("slam_offline", "--bag '" + drive_ + "/drive.bag' --output '" + again + "'").exit_code,
            0);
  for (const char* file :
       {"trajectory.txt", "trajectory.tum", "trajectory_cov.csv", "trajectory_online_cov.csv", "loop_closures.csv",
        "submaps.csv", "landmarks.csv", "associations.csv", "config.yaml", "map.bag"}) {
    EXPECT_EQ(readFile(output_ + "/" + file), readFile(again + "/" + file)) << file << " of folder and bag";
  }
  EXPECT_NE(readFile(output_ + "/report.json").find("\"se3_m\""), std::string::npos);
}

TEST_F(ProgramsTest, TheConfigurationInForceIsPrintedWithoutARunAndIsThatOfTheRun) {
  const std::string settings = " --set max_hypotheses=7 --seed 3";
  const ProgramResult printed = runProgramOfPackage("slam_offline", "--print-config" + settings);
  EXPECT_EQ(printed.exit_code, 0) << printed.output;
  EXPECT_FALSE(fs::exists(output_));
  ASSERT_EQ(runProgramOfPackage("slam_offline", offlineArguments() + settings).exit_code, 0);
  EXPECT_EQ(printed.output, readFile(output_ + "/config.yaml"));
}

TEST_F(ProgramsTest, ATruthOfOnesOwnMayBeInTumFormat) {
  ASSERT_EQ(runProgramOfPackage("slam_offline", offlineArguments()).exit_code, 0);
  const std::string estimate = output_ + "/trajectory.tum";
  std::vector<StampedPose> truth = readTumTrajectory(estimate);
  truth.erase(truth.begin(), truth.begin() + 5);
  for (StampedPose& pose : truth) pose.stamp -= 1000;  // between poses of the estimate
  truth.back().stamp += stampFromSeconds(10.0);        // behind it
  writeFileAtomically(folder_ / "truth.tum", formatTumTrajectory(truth));
  const std::string arguments = "trajectory --json --truth '" + folder_ / "truth.tum" + "' --estimate '";
  const ProgramResult result = runProgramOfPackage("evaluate", arguments + estimate + "'");
  ASSERT_EQ(result.exit_code, 0) << result.output;
  const std::size_t key = result.output.find("\"se3_m\": ");
  ASSERT_NE(key, std::string::npos) << result.output;
  EXPECT_LT(std::stod(result.output.substr(key + 9)), 1e-3);
  EXPECT_NE(result.output.find("\"frames\": " + std::to_string(truth.size() - 1)), std::string::npos) << result.output;
  const ProgramResult refused = runProgramOfPackage("evaluate", arguments + output_ + "/trajectory.txt'");
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_NE(refused.output.find("no .tum file"), std::string::npos) << refused.output;
}

TEST_F(ProgramsTest, LandmarksThatHardlyAFrameShowsAreNotMissed) {
  ASSERT_EQ(runProgramOfPackage("slam_offline", offlineArguments()).exit_code, 0);
  const auto figureWith = [&](const std::string& name, const std::string& options) {
    const ProgramResult result =
        runProgramOfPackage("evaluate", "landmarks --json --truth '" + drive_ + "/landmarks.csv' --poses '" + drive_ +
                                            "/poses.txt' --landmarks '" + output_ + "/landmarks.csv' " + options);
    EXPECT_EQ(result.exit_code, 0) << result.output;
    const std::size_t key = result.output.find("\"" + name + "\": ");
    return key == std::string::npos ? -1.0 : std::stod(result.output.substr(key + name.size() + 4));
  };
  const std::string objects = "--objects '" + drive_ + "/objects.csv' ";
  EXPECT_LT(figureWith("true_landmarks", objects), figureWith("true_landmarks", ""));
  EXPECT_LT(figureWith("true_landmarks", objects + "--min-frames 20"), figureWith("true_landmarks", objects));
  EXPECT_GT(figureWith("recall", objects), figureWith("recall", ""));
  EXPECT_EQ(figureWith("ghosts", objects), figureWith("ghosts", "")) << "what stands at a true landmark is no ghost";
}

TEST_F(ProgramsTest, SimulationWithTheSameSeedWritesTheSameBytesAndAnotherSeedOthers) {
  const std::string scenario = "--scenario '" + std::string(SMHT_SOURCE_DIR) + "/config/scenarios/short.yaml' ";
  ASSERT_EQ(runProgramOfPackage("simulate_drive", scenario + "--output '" + folder_ / "same" + "'").exit_code, 0);
  ASSERT_EQ(runProgramOfPackage("simulate_drive", scenario + "--seed 2 --output '" + folder_ / "other" + "'").exit_code,
            0);
  for (const char* file : {"objects.csv", "poses.txt", "odometry/odometry.txt", "objects_landmark.csv", "landmarks.csv",
                           "loop_pairs.csv", "drive.bag"}) {
    EXPECT_EQ(readFile(drive_ + "/" + file), readFile(folder_ / "same" + "/" + file)) << file;
  }
  EXPECT_NE(readFile(drive_ + "/objects.csv"), readFile(folder_ / "other" + "/objects.csv"));
}

TEST_F(ProgramsTest, BadOptionsAreRefused) {
  expectRefused("slam_offline", "--output '" + output_ + "'", "--dataset");
  expectRefused("slam_offline", "--dataset '" + drive_ + "'", "--output");
  expectRefused("slam_offline", offlineArguments() + "--methd ukf", "methd");
  expectRefused("slam_offline", offlineArguments() + "--fixes-topic /fix", "--bag");
  expectRefused("slam_offline", "--bag '" + drive_ + "/drive.bag' --fixes fixes.csv --output '" + output_ + "'",
                "--dataset");
  expectRefused("slam_offline", offlineArguments() + "--method magic", "method = 'magic'");
  expectRefused("slam_offline", offlineArguments() + "--seed -1", "seed = '-1'");
  expectRefused("slam_offline", offlineArguments() + "--set no.such=1", "unknown key 'no.such'");
  expectRefused("slam_offline", offlineArguments() + "--set node.queue_size=0", "out of range");
  expectRefused("slam_offline", offlineArguments() + "--config /no/such.yaml", "/no/such.yaml");
  expectRefused("slam_offline",
                offlineArguments() + "--set evaluator.check_all=false --set evaluator.tree=/no/such/tree.yaml",
                "/no/such/tree.yaml");
  expectRefused("kitti_to_bag", "--dataset '" + drive_ + "'", "--output");
  expectRefused("kitti_to_bag", "--dataset '" + drive_ + "' --start 0 --output '" + output_ + "'", "--start");
  expectRefused("simulate_drive", "", "--output");
  expectRefused("simulate_drive", "--set no.such=1 --output '" + output_ + "'", "unknown key 'no.such'");
}

TEST_F(ProgramsTest, BadFilesAreRefused) {
  const std::string objects = readFile(drive_ + "/objects.csv");
  expectRefused("slam_offline", offlineArguments() + "--objects none.csv", "none.csv");
  replaceIn("objects.csv", objects + "0,unicorn,1,2,3\n");
  expectRefused("slam_offline", offlineArguments(), "unicorn");
  expectRefused("kitti_to_bag", offlineArguments(), "unicorn");
  replaceIn("objects.csv", objects + "0,pole,one,2,3\n");
  expectRefused("slam_offline", offlineArguments(), "column 'x'");
  replaceIn("objects.csv", objects);

  expectRefused("slam_offline", offlineArguments() + "--fixes none.csv", "none.csv");
  replaceIn("fixes.csv", "time,latitude,longitude\n1,north,8\n");
  expectRefused("slam_offline", offlineArguments() + "--fixes fixes.csv", "fixes.csv:2: column 'latitude'");

  const std::string odometry = readFile(drive_ + "/odometry/odometry.txt");
  replaceIn("odometry/odometry.txt", odometry + "1 0 0 0 0 1 0 0 0 0 1 0\n");
  expectRefused("slam_offline", offlineArguments(), "times.txt has");
  replaceIn("odometry/odometry.txt", "1 0 0\n" + odometry);
  expectRefused("slam_offline", offlineArguments(), "odometry.txt:1");

  const std::string bag = readFile(drive_ + "/drive.bag");
  replaceIn("drive.bag", bag.substr(0, bag.size() - 1000));
  expectRefused("slam_offline", "--bag '" + drive_ + "/drive.bag' --output '" + output_ + "'", "drive.bag");
}

TEST_F(ProgramsTest, UnwritableOutputIsRefused) {
  writeFileAtomically(folder_ / "file", "x");
  for (const char* program : {"slam_offline", "kitti_to_bag"}) {
    const ProgramResult result = runProgramOfPackage(
        program, "--dataset '" + drive_ + "' --odometry odometry/odometry.txt --output '" + folder_ / "file" + "/x'");
    EXPECT_EQ(result.exit_code, 1) << result.output;
    EXPECT_NE(result.output.find("file/x"), std::string::npos) << result.output;
  }
}

}  // namespace
}  // namespace semantic_mht_slam
