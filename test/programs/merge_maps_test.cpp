#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "semantic_mht_slam/common/pose.h"
#include "semantic_mht_slam/common/random.h"
#include "semantic_mht_slam/io/text_file.h"

#include "support/run_program.h"
#include "support/temporary_folder.h"

namespace semantic_mht_slam {
namespace {

class MergeMapsTest : public ::testing::Test {
 protected:
  /// Sixty poles and trunks of the field of a seed, in a frame of their own, as text.
  void writeField(const std::string& file, std::uint64_t field, double yaw_rad) const {
    Rng rng(field);
    const Pose T_file_field{expRotation({0.0, 0.0, yaw_rad}), {50.0 * yaw_rad, -20.0, 1.0}};
    std::string text;
    for (int i = 0; i < 60; ++i) {
      const Eigen::Vector3d in_field_m(rng.uniform(0.0, 80.0), rng.uniform(0.0, 80.0), rng.uniform(-0.3, 0.3));
      const Eigen::Vector3d at_m = T_file_field * in_field_m;
      text += std::string(i % 3 == 0 ? "trunk" : "pole");
      for (int axis = 0; axis < 3; ++axis) text += " " + std::to_string(at_m[axis]);
      text += "\n";
    }
    writeFileAtomically(folder_ / file, text);
  }

  ProgramResult run(const std::string& arguments) const {
    return runProgramOfPackage("merge_maps", arguments + " --output '" + output_ + "'");
  }

  std::string file(const std::string& name) const { return "'" + (folder_ / name) + "' "; }

  void expectRefused(const std::string& arguments, const std::string& part) const {
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 1) << result.output;
    EXPECT_EQ(std::count(result.output.begin(), result.output.end(), '\n'), 1) << result.output;
    EXPECT_NE(result.output.find(part), std::string::npos) << result.output << "lacks: " << part;
    EXPECT_FALSE(std::filesystem::exists(output_));
  }

  const TemporaryFolder folder_;
  const std::string output_ = folder_ / "joined/ALL.bag";
};

TEST_F(MergeMapsTest, WritesOneMapOfTwoAndSaysWhyTheThirdIsAnIsland) {
  writeField("a.txt", 1, 0.3);
  writeField("b.txt", 1, 2.5);
  writeField("elsewhere.txt", 2, 1.0);
  const ProgramResult result = run(file("a.txt") + file("elsewhere.txt") + file("b.txt"));
  ASSERT_EQ(result.exit_code, 0) << result.output;
  EXPECT_NE(result.output.find("joined: a.txt, b.txt; island: elsewhere.txt ("), std::string::npos) << result.output;
  const std::string landmarks = readFile(folder_ / "joined/landmarks.csv");
  EXPECT_EQ(std::count(landmarks.begin(), landmarks.end(), '\n'), 61);  // each once, and the names of the columns
  EXPECT_NE(readFile(folder_ / "joined/merge_report.html").find("elsewhere.txt"), std::string::npos);
  const std::string report = readFile(folder_ / "joined/merge_report.json");
  EXPECT_NE(report.find("\"maps_joined\": [\n    \"a.txt\",\n    \"b.txt\"\n  ]"), std::string::npos) << report;
  EXPECT_NE(report.find("\"islands\": [\n    \"elsewhere.txt\"\n  ]"), std::string::npos) << report;

  const std::string table = folder_ / "table.csv";
  const std::string page = folder_ / "map.html";
  const ProgramResult info =
      runProgramOfPackage("map_info", "'" + output_ + "' --csv '" + table + "' --html '" + page + "'");
  EXPECT_EQ(info.exit_code, 0) << info.output;
  EXPECT_NE(info.output.find("landmarks  60"), std::string::npos) << info.output;
  EXPECT_NE(info.output.find("  trunk 20"), std::string::npos) << info.output;
  EXPECT_EQ(readFile(table), landmarks);
  EXPECT_NE(readFile(page).find("<svg"), std::string::npos);
}

TEST_F(MergeMapsTest, RefusesWhatIsNoMapWithOneLine) {
  writeField("a.txt", 1, 0.3);
  writeFileAtomically(folder_ / "broken.txt", "pole 1 2\n");
  writeFileAtomically(folder_ / "few.txt", "pole 1 2 3\npole 2 3 4\n");
  writeFileAtomically(folder_ / "empty.bag", "");
  expectRefused(file("a.txt"), "at least two maps");
  expectRefused(file("a.txt") + file("missing.bag"), "missing.bag");
  expectRefused(file("a.txt") + file("broken.txt"), "broken.txt:1");
  expectRefused(file("a.txt") + file("few.txt"), "few.txt: a map of less than three landmarks");
  expectRefused(file("a.txt") + file("empty.bag"), "empty.bag");
  expectRefused(file("a.txt") + file("a.txt"), "named twice");
  EXPECT_EQ(runProgramOfPackage("map_info", file("a.txt")).exit_code, 1);
}

}  // namespace
}  // namespace semantic_mht_slam
