#include <set>
#include <string>

#include <gtest/gtest.h>

#include "semantic_mht_slam/io/text_file.h"

#include "support/run_program.h"
#include "support/temporary_folder.h"

namespace semantic_mht_slam {
namespace {

/// A benchmark in which seed N of every method has the figure N, and the package's README.
class FillReadmeTest : public ::testing::Test {
 protected:
  static constexpr const char* kHeader =
      "sequence,odometry,objects,objects_are,method,seed,status,raw_se3_m,se3_m,running_mean_m,association_local_f1,"
      "hypotheses_mean,closures_accepted,closures_wrong\n";

  FillReadmeTest() {
    writeFileAtomically(readme_, readFile(SMHT_SOURCE_DIR "/README.md"));
    std::string references;
    for (const std::string sequence : {"00", "05", "06", "07"}) {
      for (const std::string name : {"slam_orbslam2_stereo", "slam_suma"}) {
        references += std::string(references.empty() ? "" : ",") + R"({"sequence": ")" + sequence + R"(", "name": ")" +
                      name + R"(", "figures": {"se3_m": 6.5}})";
      }
    }
    writeFileAtomically(folder_ / "results.json", R"({"references": [)" + references + "]}");
    for (const std::string sequence : {"00", "05", "06", "07"}) {
      for (const std::string odometry : {"vo_orb", "lo_simple", "vo_dfvo"}) {
        for (const std::string objects : {"best", "noisy"}) addCase(sequence, odometry, objects);
      }
    }
  }

  void addCase(const std::string& sequence, const std::string& odometry, const std::string& objects) {
    const bool is_real = sequence == "00" && objects == "best";
    for (const std::string method : {"odometry", "ukf", "mhm", "dpmhm", "no_semantics", "single_hypothesis"}) {
      for (const std::string seed : {"1", "2", "3", "4", "5"}) {
        if (method == "odometry" && seed != "1") break;
        rows_ += sequence + "," + odometry + "," + objects + (is_real ? ",real," : ",semi-real,") + method + "," +
                 seed + ",ok,9.125," + seed + ".25,8.5," + (is_real ? "" : "0.7" + seed) + "," + seed + ".0,1000,0\n";
      }
    }
  }

  ProgramResult fill() {
    writeFileAtomically(folder_ / "results.csv", header_ + rows_);
    return runProgram(SMHT_SOURCE_DIR "/scripts/fill_readme.py", "'" + folder_.path() + "' --readme '" + readme_ + "'");
  }

  /// Lines of the README that begin like this.
  std::set<std::string> lines(const std::string& begin) const {
    std::set<std::string> found;
    const std::string text = readFile(readme_);
    for (std::size_t at = text.find("\n" + begin); at != std::string::npos; at = text.find("\n" + begin, at + 1)) {
      found.insert(text.substr(at + 1, text.find('\n', at + 1) - at - 1));
    }
    return found;
  }

  TemporaryFolder folder_;
  const std::string readme_ = folder_ / "README.md";
  std::string header_ = kHeader;
  std::string rows_;
};

TEST_F(FillReadmeTest, CellsAreMediansOfTheSeeds) {
  const ProgramResult result = fill();
  ASSERT_EQ(result.exit_code, 0) << result.output;
  const std::string cell = " 9.12 → 3.25 |";
  EXPECT_EQ(lines("| ORB-SLAM2"),
            std::set<std::string>{"| ORB-SLAM2 stereo tracking (`vo_orb`) |" + cell + cell + cell + cell});
  EXPECT_EQ(lines("| `mhm`"), std::set<std::string>{"| `mhm` | 3.25 | 8.50 | 3.25 | 8.50 |"});
  ASSERT_EQ(lines("| camera-like, `ukf`").size(), 1U);
  EXPECT_EQ(lines("| camera-like, `ukf`").begin()->find("| camera-like, `ukf` | .730 | .730 | .730 | .730 | 3.0 | "),
            0U);
  EXPECT_NE(readFile(readme_).find("None of 624,000 accepted closures of all 624 runs is wrong"), std::string::npos);
}

TEST_F(FillReadmeTest, FillingAgainChangesNothing) {
  ASSERT_EQ(fill().exit_code, 0);
  const std::string once = readFile(readme_);
  EXPECT_NE(once, readFile(SMHT_SOURCE_DIR "/README.md"));
  ASSERT_EQ(fill().exit_code, 0);
  EXPECT_EQ(readFile(readme_), once);
}

TEST_F(FillReadmeTest, WhatIsMissingIsNamedAndNothingChanges) {
  const std::string all = rows_;
  const std::size_t begin = rows_.find("05,vo_orb,noisy,semi-real,dpmhm,4");
  rows_.erase(begin, rows_.find('\n', begin) + 1 - begin);
  const ProgramResult run = fill();
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_NE(run.output.find("no run 05 vo_orb noisy dpmhm with seed 4"), std::string::npos) << run.output;
  rows_ = all;
  header_.replace(header_.find(",se3_m"), 6, ",rmse_m");
  const ProgramResult column = fill();
  EXPECT_EQ(column.exit_code, 1);
  EXPECT_NE(column.output.find("no column 'se3_m'"), std::string::npos) << column.output;
  EXPECT_EQ(readFile(readme_), readFile(SMHT_SOURCE_DIR "/README.md"));
}

TEST_F(FillReadmeTest, RealObjectsHaveNoAssociationsAndSemirealOnesTakeTheirPlace) {
  ASSERT_EQ(fill().exit_code, 0);
  const std::string label = "| lidar-like, `dpmhm` | ";
  EXPECT_EQ(lines(label).begin()->find(label + ".730 "), std::string::npos);  // stays as it was
  addCase("00", "vo_orb", "semireal");
  const ProgramResult result = fill();
  ASSERT_EQ(result.exit_code, 0) << result.output;
  EXPECT_EQ(lines(label).begin()->find(label + ".730 | .730 | .730 | .730 | 3.0 | "), 0U);
}

}  // namespace
}  // namespace semantic_mht_slam
