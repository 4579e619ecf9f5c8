#include "semantic_mht_slam/io/existing_path.h"

#include <filesystem>
#include <regex>

#include <gtest/gtest.h>

#include "semantic_mht_slam/io/dataset.h"
#include "semantic_mht_slam/io/staged_folder.h"
#include "semantic_mht_slam/io/text_file.h"
#include "semantic_mht_slam/models/class_table.h"

#include "support/expect_input_error.h"
#include "support/temporary_folder.h"

namespace semantic_mht_slam {
namespace {

/// Paths that the system does not tell anything of, with its reasons.
class ExistingPathTest : public ::testing::Test {
 protected:
  ExistingPathTest() { std::filesystem::create_symlink(folder_ / "circle", folder_ / "circle"); }

  const TemporaryFolder folder_;
  const std::vector<std::pair<std::string, std::string>> untold_ = {
      {folder_ / "circle", "Too many levels of symbolic links"},
      {folder_ / "circle/inside", "Too many levels of symbolic links"},
      {folder_ / std::string(256, 'a'), "File name too long"},
      {folder_ / (std::string(256, 'a') + "/inside"), "File name too long"},
  };
};

TEST_F(ExistingPathTest, WhatIsThereIsToldFromWhatIsNot) {
  writeFileAtomically(folder_ / "file", "abc");
  EXPECT_TRUE(mayExist(folder_ / "file"));
  EXPECT_TRUE(mayExist(folder_.path()));
  EXPECT_FALSE(mayExist(folder_ / "none"));
  EXPECT_FALSE(mayExist(folder_ / "file/inside"));
  EXPECT_TRUE(isFolder(folder_.path()));
  EXPECT_FALSE(isFolder(folder_ / "file"));
  EXPECT_EQ(sizeOfFile(folder_ / "file"), 3U);
  expectInputError([&] { sizeOfFile(folder_ / "none"); }, {folder_ / "none", "no such file"});
  expectInputError([&] { sizeOfFile(folder_.path()); }, {folder_.path(), "no regular one"});
}

TEST_F(ExistingPathTest, WhatTheSystemDoesNotTellIsRefusedWithItsReason) {
  ClassInfo pole;
  pole.name = "pole";
  const ClassTable classes({pole}, "test");
  for (const auto& one : untold_) {
    const std::string& path = one.first;  // C++17's lambdas take no structured binding with them
    const std::string& reason = one.second;
    EXPECT_TRUE(mayExist(path)) << path;
    EXPECT_FALSE(isFolder(path)) << path;
    expectInputError([&] { sizeOfFile(path); }, {path, reason});
    expectInputError([&] { readFile(path); }, {path, reason});
    expectInputError([&] { writeFileAtomically(path + "/a.txt", "x"); }, {path, reason});
    expectInputError([&] { StagedFolder output(path); }, {path, reason});
    expectInputError([&] { prepareOutputFolder(path); }, {path});
    expectInputError([&] { readDataset({path, "", ""}, classes); }, {path});
  }
}

/// What is between the parenthesis at `begin` and the one that closes it.
std::string argumentsAt(const std::string& code, std::size_t begin) {
  int depth = 0;
  for (std::size_t end = begin; end < code.size(); ++end) {
    if (code[end] == '(') ++depth;
    if (code[end] == ')' && --depth == 0) return code.substr(begin, end - begin + 1);
  }
  return code.substr(begin);
}

TEST(FilesystemCallsTest, NoneThrowsForAPathThatSomebodyGives) {
  const std::regex call(
      "(fs|filesystem)::(absolute|canonical|copy|copy_file|create_director(y|ies)|(create|read)_symlink|current_path|"
      "equivalent|exists|file_size|is_[a-z_]+|permissions|proximate|relative|remove|remove_all|rename|space|"
      "(symlink_)?status|temp_directory_path|weakly_canonical|(recursive_)?directory_iterator)( [a-z]+)?\\(");
  int found = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(std::string(SMHT_SOURCE_DIR) + "/src")) {
    if (entry.path().extension() != ".cpp") continue;
    const std::string code = readFile(entry.path().string());
    for (std::sregex_iterator hit(code.begin(), code.end(), call); hit != std::sregex_iterator(); ++hit) {
      const auto end = static_cast<std::size_t>(hit->position() + hit->length());
      const std::string arguments = argumentsAt(code, end - 1);
      const bool is_quiet = arguments.find("error") != std::string::npos ||
                            arguments.find("ignored") != std::string::npos || arguments == "(status)" ||
                            arguments == "()";
      EXPECT_TRUE(is_quiet) << entry.path() << ": " << hit->str() << " throws std::filesystem_error";
      ++found;
    }
  }
  EXPECT_GT(found, 10);
}

}  // namespace
}  // namespace semantic_mht_slam
