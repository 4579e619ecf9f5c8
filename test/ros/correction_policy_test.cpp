#include "semantic_mht_slam/ros/correction_policy.h"

#include <gtest/gtest.h>

#include "semantic_mht_slam/common/random.h"

namespace semantic_mht_slam {
namespace {

constexpr Stamp kStep = 100000000;  // 0.1 s

Pose randomPose(Rng& rng, double extent_m) {
  const auto coordinate = [&](double bound) { return rng.uniform(-bound, bound); };
  return {expRotation({coordinate(1.0), coordinate(1.0), coordinate(1.0)}),
          {coordinate(extent_m), coordinate(extent_m), coordinate(extent_m)}};
}

LiveConfig limited(double speed_m_s, double turn_rate_rad_s) {
  LiveConfig config;
  config.correction = CorrectionPolicy::kLimited;
  config.correction_speed_m_s = speed_m_s;
  config.correction_turn_rate_rad_s = turn_rate_rad_s;
  return config;
}

bool isSame(const Pose& a, const Pose& b) {
  return a.translation_m == b.translation_m && a.rotation.coeffs() == b.rotation.coeffs();
}

TEST(CorrectionFollowerTest, JumpIsTheEstimateToTheBit) {
  Rng rng(1);
  CorrectionFollower follower;
  for (Stamp i = 0; i < 20; ++i) {
    const Pose T_map_odom = randomPose(rng, 50.0);
    EXPECT_TRUE(isSame(follower.follow(T_map_odom, randomPose(rng, 1000.0), i * kStep, {}), T_map_odom));
  }
}

TEST(CorrectionFollowerTest, LimitedNeverMovesTheRobotFasterThanAllowedAndArrives) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Rng rng(seed);
    const LiveConfig config = limited(rng.uniform(0.5, 3.0), rng.uniform(0.05, 0.5));
    const Pose T_odom_base = randomPose(rng, 2000.0);  // far from the origin: a turn there is a long way here
    const Pose T_map_odom = randomPose(rng, 5.0);
    CorrectionFollower follower;
    Pose before = follower.follow(Pose::identity(), T_odom_base, 0, config) * T_odom_base;
    bool has_arrived = false;
    for (Stamp i = 1; i <= 100000 && !has_arrived; ++i) {
      const Pose correction = follower.follow(T_map_odom, T_odom_base, i * kStep, config);
      const Pose now = correction * T_odom_base;
      EXPECT_LE((now.translation_m - before.translation_m).norm(), 0.1 * config.correction_speed_m_s + 1e-9);
      EXPECT_LE(angularDistance(now.rotation, before.rotation), 0.1 * config.correction_turn_rate_rad_s + 1e-7);
      before = now;
      has_arrived = isSame(correction, T_map_odom);
    }
    EXPECT_TRUE(has_arrived) << "seed " << seed;
  }
}

TEST(CorrectionFollowerTest, LimitedStartsAtTheEstimateAndStandsStillWithoutTime) {
  Rng rng(3);
  const LiveConfig config = limited(1.0, 0.1);
  const Pose first = randomPose(rng, 5.0);
  const Pose second = randomPose(rng, 5.0);
  CorrectionFollower follower;
  EXPECT_TRUE(isSame(follower.follow(first, Pose::identity(), 5 * kStep, config), first));
  const Pose held = follower.follow(second, Pose::identity(), 4 * kStep, config);
  EXPECT_NEAR((held.translation_m - first.translation_m).norm(), 0.0, 1e-12) << "a stamp that falls moves nothing";
  follower.reset();
  EXPECT_TRUE(isSame(follower.follow(second, Pose::identity(), 6 * kStep, config), second));
}

}  // namespace
}  // namespace semantic_mht_slam
