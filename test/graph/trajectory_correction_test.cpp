#include "semantic_mht_slam/graph/trajectory_correction.h"

#include <stdexcept>

#include <gtest/gtest.h>

#include "random_graph.h"

namespace semantic_mht_slam {
namespace {

std::vector<Pose> drive(Rng& rng, int poses) {
  std::vector<Pose> result{Pose::identity()};
  while (static_cast<int>(result.size()) < poses) {
    result.push_back(randomStep(rng, 0.02, 0.01, result.back() * Pose{expRotation({0, 0, 0.01}), {1.0, 0.0, 0.0}}));
  }
  return result;
}

TEST(TrajectoryCorrectionTest, MeetsEveryAnchorAndHasNoSteps) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Rng rng(seed);
    const std::vector<Pose> odometry = drive(rng, 200);
    std::vector<CorrectionAnchor> anchors;
    for (const std::size_t index : {0u, 30u, 65u, 100u, 180u}) {
      anchors.push_back({index, randomStep(rng, 0.5, 0.02, odometry[index])});
    }
    const std::vector<Pose> corrected = correctTrajectory(odometry, anchors);
    ASSERT_EQ(corrected.size(), odometry.size());
    for (const CorrectionAnchor& anchor : anchors) {
      EXPECT_LT((corrected[anchor.index].translation_m - anchor.T_map_base.translation_m).norm(), 1e-9);
    }
    for (std::size_t i = 1; i < odometry.size(); ++i) {
      const Pose step = corrected[i - 1].inverse() * corrected[i];
      const Pose odometry_step = odometry[i - 1].inverse() * odometry[i];
      EXPECT_LT((step.translation_m - odometry_step.translation_m).norm(), 0.25) << "at pose " << i;
      EXPECT_LT(angularDistance(step.rotation, odometry_step.rotation), 0.02) << "at pose " << i;
    }
  }
}

TEST(TrajectoryCorrectionTest, OneRigidMotionMovesEveryPoseRigidly) {
  Rng rng(3);
  const std::vector<Pose> odometry = drive(rng, 50);
  const Pose motion = randomStep(rng, 10.0, 1.0, Pose::identity());
  const std::vector<Pose> corrected =
      correctTrajectory(odometry, {{5, motion * odometry[5]}, {40, motion * odometry[40]}});
  for (std::size_t i = 0; i < odometry.size(); ++i) {
    EXPECT_LT((corrected[i].translation_m - (motion * odometry[i]).translation_m).norm(), 1e-9);
  }
}

TEST(TrajectoryCorrectionTest, StandingStillIsHandled) {
  const std::vector<Pose> odometry(10, Pose::identity());
  Pose moved;
  moved.translation_m.x() = 1.0;
  const std::vector<Pose> corrected = correctTrajectory(odometry, {{0, Pose::identity()}, {5, moved}});
  EXPECT_NEAR(corrected[2].translation_m.x(), 0.4, 1e-12);
}

TEST(TrajectoryCorrectionTest, BadAnchorsThrow) {
  const std::vector<Pose> odometry(10, Pose::identity());
  EXPECT_THROW(correctTrajectory(odometry, {}), std::invalid_argument);
  EXPECT_THROW(correctTrajectory(odometry, {{10, Pose::identity()}}), std::invalid_argument);
  EXPECT_THROW(correctTrajectory(odometry, {{4, Pose::identity()}, {4, Pose::identity()}}), std::invalid_argument);
}

}  // namespace
}  // namespace semantic_mht_slam
