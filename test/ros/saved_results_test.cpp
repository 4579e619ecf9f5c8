#include "../../src/ros/saved_results.h"

#include <algorithm>
#include <filesystem>

#include <gtest/gtest.h>

#include "semantic_mht_slam/io/text_file.h"

#include "support/expect_input_error.h"
#include "support/recordings.h"
#include "support/temporary_folder.h"

namespace semantic_mht_slam {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> kResultFiles = {"landmarks.csv", "landmarks.geojson", "trajectory.tum",
                                               "trajectory.txt"};

std::vector<std::string> namesIn(const std::string& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

void saveNothingTo(const std::string& folder) {
  saveResults(folder, {}, {}, makeTwoClasses(), std::nullopt);
}

TEST(SavedResultsTest, AFolderThatIsNewOrEmptyOrHoldsResultsIsWrittenTo) {
  const TemporaryFolder folder;
  const std::string results = folder / "a/b/results";
  saveNothingTo(results);
  EXPECT_EQ(namesIn(results), kResultFiles);
  writeFileAtomically(results + "/landmarks.csv", "old");
  writeFileAtomically(results + "/notes.txt", "somebody's");
  saveNothingTo(results);
  EXPECT_NE(readFile(results + "/landmarks.csv"), "old");
  EXPECT_EQ(readFile(results + "/notes.txt"), "somebody's");
  prepareOutputFolder(folder / "killed/.partial-0123456789abcdef");
  saveNothingTo(folder / "killed");
  EXPECT_EQ(namesIn(folder / "killed"), kResultFiles) << "what a killed save left is no result";
}

TEST(SavedResultsTest, AFolderOfSomebodyElseIsLeftAsItIs) {
  const TemporaryFolder folder;
  for (const std::string name : {"notes.txt", "trajectory.txt", ".hidden", ".partial-notes"}) {
    const std::string other = folder / ("of_" + name);
    prepareOutputFolder(other);
    writeFileAtomically(other + "/" + name, "somebody's");
    expectInputError([&] { saveNothingTo(other); }, {"cannot write to '" + other, "'" + name + "'", "another folder"});
    EXPECT_EQ(namesIn(other), std::vector<std::string>{name});
    EXPECT_EQ(readFile(other + "/" + name), "somebody's");
  }
  expectInputError([] { saveNothingTo("/"); }, {"cannot write to '/'"});
}

TEST(SavedResultsTest, NothingIsWrittenThroughALink) {
  const TemporaryFolder folder;
  const std::string results = folder / "results";
  saveNothingTo(results);
  writeFileAtomically(folder / "secret", "x");
  fs::remove(results + "/trajectory.tum");
  fs::create_symlink(folder / "secret", results + "/trajectory.tum");
  expectInputError([&] { saveNothingTo(results); }, {"trajectory.tum", "a symbolic link is there"});
  EXPECT_EQ(readFile(folder / "secret"), "x");
}

TEST(SavedResultsTest, AFolderThatCannotBeMadeLeavesNothingAndSaysWhy) {
  const TemporaryFolder folder;
  fs::create_symlink(folder / "circle", folder / "circle");
  expectInputError([&] { saveNothingTo(folder / "circle"); }, {"Too many levels of symbolic links"});
  expectInputError([&] { saveNothingTo(folder / ("a/b/" + std::string(256, 'c'))); }, {"File name too long"});
  EXPECT_EQ(namesIn(folder.path()), std::vector<std::string>{"circle"});
}

}  // namespace
}  // namespace semantic_mht_slam
