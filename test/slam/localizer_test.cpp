#include "semantic_mht_slam/slam/localizer.h"

#include <memory>

#include <gtest/gtest.h>

#include "semantic_mht_slam/slam/slam.h"

#include "support/square_drive.h"

namespace semantic_mht_slam {
namespace {

/// A map of one round, and a second session in an odometry frame of its own.
class LocalizerTest : public testing::TestWithParam<int> {
 protected:
  LocalizerTest()
      : drive_(static_cast<std::uint64_t>(GetParam())), slam_(defaultsOf(Method::kDpmhm), makeStreetClasses()) {
    drive_.feed(slam_, 0, 500);
    slam_.finish();
  }

  /// Feeds frames as another session: its odometry begins at its own origin, its stamps at 0.
  void feed(int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const Pose T_odom_base = SquareDrive::odometryAt(first_).inverse() * SquareDrive::odometryAt(i);
      slam_.addOdometry({SquareDrive::stampAt(i - first_), T_odom_base});
      slam_.addDetections(SquareDrive::stampAt(i - first_) - 30000000, drive_.detectionsAt(i));
    }
  }

  void beginAt(int first) {
    first_ = first;
    slam_.beginSession();
  }

  /// Horizontal distance of the present pose from where the first round has been at the same place.
  double errorAt(int i) const {
    const auto first_round = trajectoryOf(slam_);
    const Pose& T_map_there = first_round[static_cast<std::size_t>(i % 480)].T_world_base;
    return (latestPoseOf(slam_)->T_world_base.translation_m - T_map_there.translation_m).head<2>().norm();
  }

  SquareDrive drive_;
  Slam slam_;
  int first_ = 0;
};

TEST_P(LocalizerTest, LostVehicleFindsItselfAndTracksWithoutChangingTheMap) {
  slam_.localize();
  const std::size_t submaps = slam_.map().submaps().size();
  const std::size_t landmarks = landmarksOf(slam_).size();
  for (const int start : {40, 170, 333}) {
    beginAt(start);
    EXPECT_FALSE(isLocated(slam_.mode()));
    int i = start;
    while (!isLocated(slam_.mode()) && i < start + 50) feed(i, i + 1), ++i;
    ASSERT_TRUE(isLocated(slam_.mode())) << start;
    for (; i < start + 120; ++i) {
      feed(i, i + 1);
      EXPECT_LT(errorAt(i), 1.0) << start << " " << i;
    }
  }
  EXPECT_EQ(slam_.map().submaps().size(), submaps);
  EXPECT_EQ(landmarksOf(slam_).size(), landmarks);
}

TEST_P(LocalizerTest, PoseFromOutsideEndsBeingLost) {
  slam_.localize();
  beginAt(100);
  EXPECT_FALSE(slam_.expectAt(Pose::identity(), 1.0)) << "without odometry nobody knows when that was";
  feed(100, 101);
  Pose T_map_base = trajectoryOf(slam_)[100].T_world_base;
  T_map_base.translation_m.x() += 1.5;
  EXPECT_TRUE(slam_.expectAt(T_map_base, 2.0));
  EXPECT_TRUE(isLocated(slam_.mode()));
  feed(101, 160);
  EXPECT_LT(errorAt(159), 1.0);
}

TEST_P(LocalizerTest, UncertaintyFromOutsideCountsHoweverLittleTheOdometryDrifts) {
  SlamConfig config = defaultsOf(Method::kDpmhm);
  config.mapper.odometry.learn = false;
  config.mapper.odometry.noise = {0.001, 0.001, 0.001, 1e-5, 1e-4, 1e-5};
  Slam slam(config, makeStreetClasses(), slam_.snapshot());
  slam.localize();
  slam.beginSession();
  const auto feedTo = [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      slam.addOdometry({SquareDrive::stampAt(i - 100), SquareDrive::odometryAt(i)});
      slam.addDetections(SquareDrive::stampAt(i - 100) - 30000000, drive_.detectionsAt(i));
    }
  };
  feedTo(100, 101);
  Pose T_map_base = trajectoryOf(slam)[100].T_world_base;
  T_map_base.translation_m.x() += 3.5;
  ASSERT_TRUE(slam.expectAt(T_map_base, 3.0));
  feedTo(101, 115);
  const Pose T_map_there = trajectoryOf(slam)[114].T_world_base;
  EXPECT_LT((latestPoseOf(slam)->T_world_base.translation_m - T_map_there.translation_m).head<2>().norm(), 1.0);
}

TEST_P(LocalizerTest, AnotherSessionGoesOnInTheSameMap) {
  const std::size_t submaps = slam_.map().submaps().size();
  const std::size_t landmarks = landmarksOf(slam_).size();
  beginAt(700);
  feed(700, 1000);
  slam_.finish();
  EXPECT_FALSE(isLocalizing(slam_.mode()));
  EXPECT_GT(slam_.map().submaps().size(), submaps + 5);
  EXPECT_LT(landmarksOf(slam_).size(), landmarks + landmarks / 4) << "what was known is not mapped twice";
  EXPECT_LT(errorAt(999), 1.0);
  int accepted = 0;
  for (const LoopClosureRecord& record : slam_.map().closures()) accepted += record.is_accepted ? 1 : 0;
  EXPECT_GT(accepted, 5);
}

TEST_P(LocalizerTest, ElsewhereItStaysLost) {
  slam_.localize();
  const SquareDrive elsewhere(static_cast<std::uint64_t>(GetParam()) + 100);
  slam_.beginSession();
  elsewhere.feed(slam_, 0, 300);
  EXPECT_FALSE(isLocated(slam_.mode()));
}

/// Rounds of the square, each place known after two.
class KnownPlaceTest : public testing::TestWithParam<int> {
 protected:
  explicit KnownPlaceTest(int leaves_m = SquareDrive::kNever_m)
      : drive_(static_cast<std::uint64_t>(GetParam()), leaves_m), slam_(config(), makeStreetClasses()) {}

  static SlamConfig config() {
    SlamConfig config = defaultsOf(Method::kDpmhm);
    config.localization.known_passes = 2;
    return config;
  }

  double errorAt(int i) const {
    return (latestPoseOf(slam_)->T_world_base.translation_m - drive_.truthAt(i).translation_m).head<2>().norm();
  }

  std::size_t keyframes() const { return slam_.map().keyframes().size(); }

  SquareDrive drive_;
  Slam slam_;
};

TEST_P(KnownPlaceTest, TheMapDoesNotGrowInPlacesThatAreKnownAndThePoseStaysGood) {
  drive_.feed(slam_, 0, 1200);
  EXPECT_TRUE(isFollowing(slam_.mode()));
  EXPECT_FALSE(isLocalizing(slam_.mode())) << "nobody asked for that";
  const std::size_t before = keyframes();
  for (int i = 1200; i < 2400; ++i) {
    drive_.feed(slam_, i, i + 1);
    EXPECT_LT(errorAt(i), 1.5) << i;
  }
  EXPECT_EQ(keyframes(), before);
  EXPECT_EQ(trajectoryOf(slam_).size(), 2400U);
}

TEST_P(KnownPlaceTest, AMapThatWasSavedAtAKnownPlaceIsFollowedAtOnce) {
  drive_.feed(slam_, 0, 1300);
  ASSERT_TRUE(isFollowing(slam_.mode()));
  Slam loaded(config(), makeStreetClasses(), slam_.snapshot());
  EXPECT_TRUE(isFollowing(loaded.mode()));
  EXPECT_TRUE(isLocated(loaded.mode()));
  const std::size_t before = loaded.map().keyframes().size();
  for (int i = 1300; i < 1500; ++i) {
    drive_.feed(loaded, i, i + 1);
    const Pose T_map_base = latestPoseOf(loaded)->T_world_base;
    EXPECT_LT((T_map_base.translation_m - drive_.truthAt(i).translation_m).head<2>().norm(), 1.5) << i;
  }
  EXPECT_EQ(loaded.map().keyframes().size(), before);
}

class LeavingKnownPlaceTest : public KnownPlaceTest {
 protected:
  LeavingKnownPlaceTest() : KnownPlaceTest(1560) {}
};

TEST_P(LeavingKnownPlaceTest, NewPlacesAreMappedAtOnce) {
  drive_.feed(slam_, 0, 1550);
  ASSERT_TRUE(isFollowing(slam_.mode()));
  const std::size_t before = keyframes();
  drive_.feed(slam_, 1550, 1850);  // 290 m straight on, where the rounds turned
  EXPECT_FALSE(isFollowing(slam_.mode()));
  EXPECT_TRUE(isLocated(slam_.mode()));
  slam_.finish();
  EXPECT_GT(keyframes(), before + 20);
  EXPECT_LT(errorAt(1849), 3.0);
}

TEST(KnownPlaceOffTest, WithoutAnyWantedEverythingIsMapped) {
  SlamConfig config = defaultsOf(Method::kDpmhm);
  config.localization.known_passes = 0;
  Slam slam(config, makeStreetClasses());
  SquareDrive(1).feed(slam, 0, 1500);
  EXPECT_FALSE(isFollowing(slam.mode()));
  EXPECT_GT(slam.map().submaps().back()->end, SquareDrive::stampAt(1400));
}

INSTANTIATE_TEST_SUITE_P(Seeds, KnownPlaceTest, testing::Values(1, 2, 3));
INSTANTIATE_TEST_SUITE_P(Seeds, LeavingKnownPlaceTest, testing::Values(1, 2, 3));
INSTANTIATE_TEST_SUITE_P(Seeds, LocalizerTest, testing::Values(1, 2, 3));

TEST(LocalizerErrorTest, WithoutAMapThereIsNothingToLocalizeIn) {
  Slam slam(defaultsOf(Method::kDpmhm), makeStreetClasses());
  EXPECT_THROW(slam.localize(), std::logic_error);
  EXPECT_THROW(Slam(defaultsOf(Method::kOdometry), makeStreetClasses()).localize(), std::logic_error);
}

}  // namespace
}  // namespace semantic_mht_slam
