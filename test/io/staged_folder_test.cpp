#include "semantic_mht_slam/io/staged_folder.h"

#include <filesystem>

#include <gtest/gtest.h>
#include <unistd.h>

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

TEST(StagedFolderTest, EveryFolderThatWasMadeIsRemovedWithoutACommit) {
  const TemporaryFolder folder;
  { const StagedFolder output(folder / "a/b/c/d"); }
  EXPECT_TRUE(fs::is_empty(folder.path()));
  expectInputError([&] { StagedFolder output(folder / ("a/b/" + std::string(256, 'c'))); }, {"File name too long"});
  EXPECT_TRUE(fs::is_empty(folder.path()));
  prepareOutputFolder(folder / "old");
  {
    const StagedFolder output(folder / "old/new/deep");
    writeFileAtomically(folder / "old/new/b.txt", "somebody's");
  }
  EXPECT_TRUE(fs::exists(folder / "old/new/b.txt"));
  EXPECT_FALSE(fs::exists(folder / "old/new/deep"));
  {
    StagedFolder output(folder / "taken");
    prepareOutputFolder(output.staging() + "/inside");
    writeFileAtomically(output.staging() + "/inside/b.txt", "b");
    prepareOutputFolder(folder / "taken/inside/b.txt");
    expectInputError([&] { output.commit(); }, {"inside/b.txt"});
  }
  EXPECT_TRUE(fs::exists(folder / "taken/inside/b.txt")) << "somebody else's";
}

TEST(StagedFolderTest, NobodyCanGuessWhereFilesAreStaged) {
  const TemporaryFolder folder;
  const StagedFolder one(folder / "out");
  const StagedFolder other(folder / "out");
  EXPECT_NE(one.staging(), other.staging());
  for (const StagedFolder* output : {&one, &other}) {
    const std::string name = fs::path(output->staging()).filename().string();
    EXPECT_TRUE(StagedFolder::isStaging(name)) << name;
    EXPECT_TRUE(fs::is_directory(output->staging())) << "a folder in use stays";
  }
  EXPECT_FALSE(StagedFolder::isStaging(".partial." + std::to_string(::getpid())));
  EXPECT_FALSE(StagedFolder::isStaging(".partial-0123456789abcdef.txt"));
}

TEST(StagedFolderTest, WhatAKilledProgramLeftIsRemoved) {
  const TemporaryFolder folder;
  prepareOutputFolder(folder / "out/.partial-0123456789abcdef/inside");
  prepareOutputFolder(folder / "out/.partial-notes");
  prepareOutputFolder(folder / "aside");
  writeFileAtomically(folder / "aside/a.txt", "a");
  fs::create_symlink(folder / "aside", folder / "out/.partial-fedcba9876543210");
  { StagedFolder(folder / "out").commit(); }
  EXPECT_FALSE(fs::exists(folder / "out/.partial-0123456789abcdef"));
  EXPECT_TRUE(fs::exists(folder / "out/.partial-notes"));
  EXPECT_EQ(readFile(folder / "aside/a.txt"), "a") << "a link is not followed";
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
