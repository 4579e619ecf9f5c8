#include "semantic_mht_slam/io/staged_folder.h"

#include <filesystem>

#include <gtest/gtest.h>

#include "semantic_mht_slam/io/text_file.h"

#include "support/expect_input_error.h"
#include "support/temporary_folder.h"

namespace semantic_mht_slam {
namespace {

namespace fs = std::filesystem;

TEST(StagedFolderTest, FilesAppearTogetherAtTheCommit) {
  const TemporaryFolder folder;
  {
    StagedFolder output(folder / "out");
    prepareOutputFolder(output.staging() + "/inside");
    writeFileAtomically(output.staging() + "/a.txt", "a");
    writeFileAtomically(output.staging() + "/inside/b.txt", "b");
    EXPECT_FALSE(fs::exists(folder / "out/a.txt"));
    output.commit();
  }
  EXPECT_EQ(readFile(folder / "out/a.txt"), "a");
  EXPECT_EQ(readFile(folder / "out/inside/b.txt"), "b");
  const auto entries = fs::directory_iterator(folder / "out");
  EXPECT_EQ(std::distance(begin(entries), end(entries)), 2);
}

TEST(StagedFolderTest, WithoutACommitNothingIsLeft) {
  const TemporaryFolder folder;
  {
    const StagedFolder output(folder / "new");
    writeFileAtomically(output.staging() + "/a.txt", "a");
  }
  EXPECT_FALSE(fs::exists(folder / "new"));
  prepareOutputFolder(folder / "old");
  writeFileAtomically(folder / "old/a.txt", "before");
  {
    const StagedFolder output(folder / "old");
    writeFileAtomically(output.staging() + "/a.txt", "after");
  }
  EXPECT_EQ(readFile(folder / "old/a.txt"), "before");
}

TEST(StagedFolderTest, APlaceTakenByAFolderIsNamedAndNothingMoves) {
  const TemporaryFolder folder;
  prepareOutputFolder(folder / "out/b.txt");
  StagedFolder output(folder / "out");
  writeFileAtomically(output.staging() + "/a.txt", "a");
  writeFileAtomically(output.staging() + "/b.txt", "b");
  expectInputError([&] { output.commit(); }, {"out/b.txt"});
  EXPECT_FALSE(fs::exists(folder / "out/a.txt"));
}

}  // namespace
}  // namespace semantic_mht_slam
