#include "semantic_mht_slam/ros/map_path.h"

#include <cstdlib>
#include <filesystem>

#include <gtest/gtest.h>

#include "semantic_mht_slam/io/text_file.h"

#include "support/expect_input_error.h"
#include "support/temporary_folder.h"

namespace semantic_mht_slam {
namespace {

namespace fs = std::filesystem;

TEST(MapPathTest, HomeAndRelativePathsBecomeAbsolute) {
  const std::string home = std::getenv("HOME");
  EXPECT_EQ(mapPath("~/maps/town.bag", ""), (fs::path(home) / "maps/town.bag").lexically_normal().string());
  EXPECT_EQ(mapPath("town.bag", ""), (fs::current_path() / "town.bag").string());
  EXPECT_EQ(mapPath("/data/./x/../town.bag", ""), "/data/town.bag");
  EXPECT_EQ(mapPath("town.bag", "/data/maps"), "/data/maps/town.bag");
  EXPECT_EQ(mapPath("/data/maps/town.bag", "/data/maps/"), "/data/maps/town.bag");
  expectInputError([] { mapPath("", ""); }, {"empty"});
  expectInputError([] { mapPath("~root/town.bag", ""); }, {"~root/town.bag"});
  expectInputError([] { mapPath("/data/", ""); }, {"/data/", "folder"});
}

TEST(MapPathTest, PathsWithControlCharactersAreRefused) {
  for (const std::string& end :
       {std::string("\0.txt", 5), std::string("\n"), std::string("\x1B[2J"), std::string("\x7F")}) {
    const std::string code = std::to_string(static_cast<unsigned char>(end.front()));
    for (const auto& pathOf : {mapPath, resultsPath}) {
      expectInputError([&] { pathOf("/data/town" + end + "x", ""); }, {"control character " + code, "'/data/town'"});
    }
  }
  EXPECT_EQ(mapPath("/data/Zürich 1.bag", ""), "/data/Zürich 1.bag");
}

TEST(MapPathTest, ResultsGoToAFolderThatIsNotTheRoot) {
  EXPECT_EQ(resultsPath("/data/town/", ""), "/data/town");
  EXPECT_EQ(resultsPath("town", "/data/maps"), "/data/maps/town");
  for (const std::string path : {"/", "//", "/data/..", "/./"}) {
    expectInputError([&] { resultsPath(path, ""); }, {"is the root of the file system"});
  }
  expectInputError([] { resultsPath("/tmp/town", "/data/maps"); }, {"is outside of '/data/maps' (node/map_folder)"});
}

TEST(MapPathTest, OutsideOfTheFolderNothingIsReached) {
  const TemporaryFolder folder;
  const std::string maps = folder / "maps";
  prepareOutputFolder(maps + "/old");
  prepareOutputFolder(folder / "maps_of_others");
  writeFileAtomically(folder / "secret.bag", "x");
  fs::create_symlink(folder / "secret.bag", maps + "/link.bag");
  fs::create_symlink(folder.path(), maps + "/up");
  EXPECT_EQ(mapPath("old/town.bag", maps), maps + "/old/town.bag");
  for (const std::string path : {"../secret.bag", "/etc/passwd", "link.bag", "up/secret.bag", "old/../../secret.bag",
                                 "../maps_of_others/town.bag", "~/town.bag"}) {
    expectInputError([&] { mapPath(path, maps); }, {"is outside of '", "maps'", "node/map_folder"});
  }
}

}  // namespace
}  // namespace semantic_mht_slam
