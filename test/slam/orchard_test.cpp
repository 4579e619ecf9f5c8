#include <gtest/gtest.h>

#include "semantic_mht_slam/slam/slam.h"

#include "support/orchard_drive.h"

namespace semantic_mht_slam {
namespace {

TEST(OrchardTest, EveryTreeIsOneLandmarkAndEveryLandmarkOneTree) {
  const std::pair<std::uint64_t, double> seeds_and_drifts[] = {{1, 0.0002}, {2, -0.0004}, {4, 0.0004}};
  for (const auto& [seed, drift_rad_per_m] : seeds_and_drifts) {
    OrchardDrive drive(seed, drift_rad_per_m);
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
    EXPECT_LE(mixed, drive.trees() / 100) << "seed " << seed;
    EXPECT_GE(once, drive.trees() - drive.trees() / 50) << "seed " << seed;
    EXPECT_EQ(landmarks_of_tree.size(), drive.trees()) << "seed " << seed;
  }
}

}  // namespace
}  // namespace semantic_mht_slam
