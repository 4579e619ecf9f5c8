#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "semantic_mht_slam/common/text.h"
#include "semantic_mht_slam/io/text_file.h"

#include "support/run_program.h"
#include "support/temporary_folder.h"

namespace semantic_mht_slam {
namespace {

namespace fs = std::filesystem;

std::string quoted(const std::string& text) {
  return "'" + text + "'";
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// A CSV file: cells by row and name of the column.
class Table {
 public:
  explicit Table(const std::string& path) : content_(readFile(path)) {
    forEachLine(content_, [&](int, std::string_view line) { rows_.push_back(split(line, ',')); });
  }
  std::size_t rows() const { return rows_.size() - 1; }
  std::string at(std::size_t row, const std::string& column) const {
    const auto found = std::find(rows_.front().begin(), rows_.front().end(), column);
    if (found == rows_.front().end()) return "no column " + column;
    return std::string(rows_.at(row + 1).at(static_cast<std::size_t>(found - rows_.front().begin())));
  }

 private:
  const std::string content_;
  std::vector<std::vector<std::string_view>> rows_;
};

/// The benchmark on a short simulated drive: two methods, two seeds.
class BenchmarkTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder;
    const ProgramResult drive =
        runProgramOfPackage("simulate_drive", "--scenario " + quoted(SMHT_SOURCE_DIR "/config/scenarios/short.yaml") +
                                                  " --set route.length=300 --output " + quoted(data() + "/town"));
    EXPECT_EQ(drive.exit_code, 0) << drive.output;
    const ProgramResult first = benchmark(output());
    EXPECT_EQ(first.exit_code, 0) << first.output;
    EXPECT_TRUE(has(first.output, "4 runs made, 0 found complete, 0 failed")) << first.output;
  }
  static void TearDownTestSuite() { delete folder_; }

  static std::string data() { return *folder_ / "the data"; }
  static std::string output() { return *folder_ / "a report"; }
  static std::string runFolder(const std::string& method, int seed) {
    return output() + "/runs/town/odometry/objects/" + method + "/seed_" + std::to_string(seed);
  }
  static ProgramResult benchmark(const std::string& output, const std::string& more = "--odometries odometry") {
    return runProgramOfPackage("evaluate", "benchmark --data " + quoted(data()) + " --output " + quoted(output) +
                                               " --methods dpmhm,ukf --seeds 1-2 " + more);
  }

  /// The report without what is measured anew each time.
  static std::string unmeasured(const std::string& folder) {
    const std::string html = readFile(folder + "/report.html");
    const std::size_t begin = html.find("<!-- measured begin -->");
    const std::size_t end = html.find("<!-- measured end -->");
    EXPECT_LT(begin, end);
    return html.substr(0, begin) + html.substr(end);
  }

  static TemporaryFolder* folder_;
};

TemporaryFolder* BenchmarkTest::folder_ = nullptr;

TEST_F(BenchmarkTest, EveryRunIsOneRowAndTheObjectsAreCalledWhatTheyAre) {
  const Table results(output() + "/results.csv");
  ASSERT_EQ(results.rows(), 4U);
  EXPECT_EQ(results.at(0, "method"), "ukf");
  EXPECT_EQ(results.at(3, "method"), "dpmhm");
  EXPECT_EQ(results.at(3, "seed"), "2");
  EXPECT_EQ(results.at(3, "status"), "ok");
  EXPECT_EQ(results.at(3, "objects_are"), "simulated");
  EXPECT_GT(parseDouble(results.at(3, "se3_m")).value(), 0.0);
  EXPECT_GT(parseDouble(results.at(3, "association_local_f1")).value(), 0.8);
  EXPECT_EQ(Table(output() + "/times.csv").rows(), 4U);
}

TEST_F(BenchmarkTest, TheReportIsWellFormedAndNeedsNothingElse) {
  const std::string html = readFile(output() + "/report.html");
  for (const char* part : {"src=", "href=", "url(", "@import", "<script"}) EXPECT_FALSE(has(html, part)) << part;
  EXPECT_TRUE(has(html, "RMSE over the frames: town"));
  EXPECT_TRUE(has(html, "Hypotheses that live"));
  EXPECT_TRUE(has(html, "dpmhm is "));
  EXPECT_TRUE(has(html, "max_hypotheses: "));
  const std::string parse = "import sys, xml.etree.ElementTree as t; t.parse(sys.argv[1])";
  const std::string command = "/usr/bin/python3 -c " + quoted(parse) + " " + quoted(output() + "/report.html");
  EXPECT_EQ(std::system(command.c_str()), 0);
}

TEST_F(BenchmarkTest, AnotherBenchmarkWithAnotherNumberOfJobsWritesTheSameBytes) {
  const std::string again = *folder_ / "again";
  ASSERT_EQ(benchmark(again, "--odometries odometry --jobs 1").exit_code, 0);
  for (const char* file : {"results.csv", "results.json", "results.md", "config.yaml"}) {
    EXPECT_EQ(readFile(output() + "/" + file), readFile(again + "/" + file)) << file;
  }
  EXPECT_EQ(unmeasured(output()), unmeasured(again));
}

TEST_F(BenchmarkTest, OnlyRunsThatAreMissingOrOfAnotherConfigurationAreMade) {
  EXPECT_TRUE(has(benchmark(output()).output, "0 runs made, 4 found complete"));
  fs::remove(runFolder("dpmhm", 2) + "/report.json");
  EXPECT_TRUE(has(benchmark(output()).output, "1 runs made, 3 found complete"));
  const std::string copy = *folder_ / "copy";
  fs::copy(output(), copy, fs::copy_options::recursive);
  const ProgramResult changed = benchmark(copy, "--odometries odometry --set max_hypotheses=7");
  EXPECT_TRUE(has(changed.output, "4 runs made, 0 found complete")) << changed.output;
  EXPECT_TRUE(has(readFile(copy + "/config.yaml"), "max_hypotheses: 7"));
}

TEST_F(BenchmarkTest, ARunThatFailsIsToldAndDoesNotStopTheOthers) {
  const std::string odometry = readFile(data() + "/town/odometry/odometry.txt");
  const std::string broken = data() + "/town/odometry/broken.txt";
  writeFileAtomically(broken, odometry.substr(odometry.find('\n') + 1));
  const ProgramResult result = benchmark(*folder_ / "failing", "");
  fs::remove(broken);
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_TRUE(has(result.output, "town broken objects dpmhm seed 2 failed, code 1: slam_offline: ")) << result.output;
  EXPECT_TRUE(has(result.output, "8 runs made, 0 found complete, 4 failed")) << result.output;
  const Table results(*folder_ / "failing" + "/results.csv");
  ASSERT_EQ(results.rows(), 8U);
  EXPECT_EQ(results.at(0, "status").rfind("failed: code 1", 0), 0U);
  EXPECT_EQ(results.at(0, "se3_m"), "");
  EXPECT_EQ(results.at(7, "status"), "ok");
  EXPECT_TRUE(has(readFile(*folder_ / "failing" + "/report.html"), "4 of 8 runs FAILED"));
}

TEST_F(BenchmarkTest, LiveEstimateAndLoopClosuresAreScored) {
  const std::string copy = *folder_ / "scored";
  fs::copy(output(), copy, fs::copy_options::recursive);
  const std::string run = copy + "/runs/town/odometry/objects/dpmhm/seed_2";
  fs::copy_file(run + "/trajectory.tum", run + "/trajectory_online.tum", fs::copy_options::overwrite_existing);
  writeFileAtomically(run + "/loop_closures.csv",
                      "query_frame,match_frame,accepted,score,inliers,tx,ty,tz,qx,qy,qz,qw,submap\n"
                      "300,300,1,0.5,9,0,0,0,0,0,0,1,3\n300,300,1,0.5,9,5,0,0,0,0,0,1,3\n300,20,0,0.1,0,,,,,,,,1\n");
  const ProgramResult result = benchmark(copy);
  EXPECT_TRUE(has(result.output, "4 found complete, 0 failed")) << result.output;
  EXPECT_TRUE(has(result.output, "1 of them WRONG: town odometry best dpmhm seed 2")) << result.output;
  const Table results(copy + "/results.csv");
  EXPECT_EQ(results.at(3, "online_se3_m"), results.at(3, "se3_m"));
  EXPECT_EQ(results.at(3, "online_running_mean_m"), results.at(3, "running_mean_m"));
  EXPECT_EQ(results.at(3, "closures_checked"), "3.000000");
  EXPECT_EQ(results.at(3, "closures_accepted"), "2.000000");
  EXPECT_EQ(results.at(3, "closures_precision"), "0.500000");
}

TEST_F(BenchmarkTest, AResultThatCannotBeScoredIsAFailureOfItsRunOnly) {
  const std::string copy = *folder_ / "unscorable";
  fs::copy(output(), copy, fs::copy_options::recursive);
  writeFileAtomically(copy + "/runs/town/odometry/objects/ukf/seed_1/loop_closures.csv",
                      "query_frame,match_frame,accepted,tx,ty,tz\n300,-1,0,,,\n");
  const ProgramResult result = benchmark(copy);
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_TRUE(has(result.output, "ukf seed 1 cannot be scored: ")) << result.output;
  EXPECT_TRUE(has(result.output, "4 found complete, 1 failed")) << result.output;
  EXPECT_EQ(Table(copy + "/results.csv").at(1, "status"), "ok");
}

TEST_F(BenchmarkTest, BadOptionsAreRefusedBeforeAnythingRuns) {
  const std::string nothing = *folder_ / "nothing";
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"--sequences none", "none"},         {"--odometries none", "none.txt"}, {"--objects noisy", "objects_noisy.csv"},
      {"--objects best,best", "twice"},     {"--jobs 0", "--jobs 0"},          {"--set no.such=1", "no.such"},
      {"--config /no/such.yaml", "no/such"}};
  for (const auto& [option, part] : cases) {
    const ProgramResult result = benchmark(nothing, option);
    EXPECT_EQ(result.exit_code, 1) << option;
    EXPECT_TRUE(has(result.output, part)) << option << ": " << result.output;
  }
  for (const std::string option : {"--methods magic --seeds 1", "--seeds 5-1", "--seeds x", "--seeds 1,,2"}) {
    const ProgramResult result = runProgramOfPackage(
        "evaluate", "benchmark --data " + quoted(data()) + " --output " + quoted(nothing) + " " + option);
    EXPECT_EQ(result.exit_code, 1) << option;
    EXPECT_TRUE(has(result.output, option.substr(0, option.find(' ', 10)))) << option << ": " << result.output;
  }
  EXPECT_FALSE(fs::exists(nothing));
}

}  // namespace
}  // namespace semantic_mht_slam
