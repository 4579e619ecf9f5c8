#include <gtest/gtest.h>

#include "semantic_mht_slam/slam/slam.h"

#include "support/orchard_drive.h"

namespace semantic_mht_slam {
namespace {

TEST(OrchardTest, EveryTreeIsOneLandmarkAndEveryLandmarkOneTree) {
  OrchardDrive drive(4, 0.0004);
  Slam slam(defaultsOf(Method::kDpmhm), makeOrchardClasses());
  drive.feed(slam);
  std::map<int, int> landmarks_of_tree;
  std::size_t mixed = 0;
  for (const auto& [landmark, trees] : drive.treesOfLandmarks(slam)) {
    mixed += trees.size() > 1 ? 1 : 0;
    for (const int tree : trees) ++landmarks_of_tree[tree];
  }
  std::size_t once = 0;
  for (const auto& [tree, landmarks] : landmarks_of_tree) once += landmarks == 1 ? 1 : 0;
  EXPECT_LE(mixed, drive.trees() / 100);
  EXPECT_GE(once, drive.trees() - drive.trees() / 50);
  EXPECT_EQ(landmarks_of_tree.size(), drive.trees());
}

}  // namespace
}  // namespace semantic_mht_slam
