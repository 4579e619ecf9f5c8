#include <filesystem>

#include <gtest/gtest.h>

#include "semantic_mht_slam/bags/bag_file.h"
#include "semantic_mht_slam/bags/map_file.h"
#include "semantic_mht_slam/ros/map_path.h"

#include "support/expect_input_error.h"
#include "support/recordings.h"
#include "support/temporary_folder.h"

namespace semantic_mht_slam {
namespace {

/// Paths that the system does not tell anything of are refused with its reason, by whatever a service or a program is
/// asked to do with them.
TEST(UntoldPathsTest, MapsAndBagsOfSuchAreRefusedWithTheReasonOfTheSystem) {
  const TemporaryFolder folder;
  const ClassTable classes = makeTwoClasses();
  const std::string circle = folder / "circle.bag";
  std::filesystem::create_symlink(circle, circle);
  const std::string long_name = folder / std::string(256, 'a');
  const std::string circle_reason = "Too many levels of symbolic links";
  const std::string long_reason = "File name too long";
  const std::vector<std::pair<std::string, std::string>> untold = {{circle, circle_reason},
                                                                   {circle + "/map.bag", circle_reason},
                                                                   {long_name, long_reason},
                                                                   {long_name + "/map.bag", long_reason}};
  for (const auto& [path, reason] : untold) {
    expectInputError([&] { readMapFile(path, {}, classes, [] { return true; }); }, {path, reason});
    expectInputError([&] { readBag(path, classes, {}, {}); }, {path, reason});
    EXPECT_EQ(mapPath(path, ""), path);
  }
  expectInputError([&] { mapPath(circle, folder.path()); }, {circle, circle_reason});
}

}  // namespace
}  // namespace semantic_mht_slam
