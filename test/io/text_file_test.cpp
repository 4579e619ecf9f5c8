#include "semantic_mht_slam/io/text_file.h"

#include <filesystem>
#include <vector>

#include <gtest/gtest.h>

#include "support/expect_input_error.h"
#include "support/temporary_folder.h"

namespace semantic_mht_slam {
namespace {

TEST(TextFileTest, LinesAreNumberedAndCommentsAndBlanksSkipped) {
  std::vector<std::pair<int, std::string>> lines;
  forEachLine("# head\n\n a 1 \r\nb", [&](int number, std::string_view line) { lines.emplace_back(number, line); });
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0], (std::pair<int, std::string>(3, "a 1")));
  EXPECT_EQ(lines[1], (std::pair<int, std::string>(4, "b")));
}

TEST(TextFileTest, WrittenFilesReadBackAndLeaveNoTemporaryFile) {
  const TemporaryFolder folder;
  writeFileAtomically(folder / "a.txt", "old");
  writeFileAtomically(folder / "a.txt", "new content\n");
  EXPECT_EQ(readFile(folder / "a.txt"), "new content\n");
  const auto entries = std::filesystem::directory_iterator(folder.path());
  EXPECT_EQ(std::distance(begin(entries), end(entries)), 1);
}

TEST(TextFileTest, UnreadableAndUnwritablePlacesAreNamed) {
  const TemporaryFolder folder;
  expectInputError([&] { readFile(folder / "none.txt"); }, {"none.txt", "No such file"});
  expectInputError([&] { readFile(folder.path()); }, {folder.path(), "folder"});
  expectInputError([&] { writeFileAtomically(folder / "none/a.txt", "x"); }, {"none/a.txt", "No such file"});
  writeFileAtomically(folder / "file", "x");
  expectInputError([&] { prepareOutputFolder(folder / "file"); }, {"file"});
  expectInputError([&] { prepareOutputFolder(folder / "file/inside"); }, {"file/inside"});
}

}  // namespace
}  // namespace semantic_mht_slam
