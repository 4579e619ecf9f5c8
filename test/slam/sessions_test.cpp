#include <gtest/gtest.h>

#include "semantic_mht_slam/slam/slam.h"

#include "support/square_drive.h"

namespace semantic_mht_slam {
namespace {

/// A drive whose odometry is set to zero at a frame, a whole round behind it.
class SessionsTest : public testing::TestWithParam<int> {
 protected:
  SessionsTest()
      : drive_(static_cast<std::uint64_t>(GetParam())), slam_(defaultsOf(Method::kDpmhm), makeStreetClasses()) {}

  void feed(int begin, int end, const Pose& T_zero_odom, Stamp pause = 0) {
    for (int i = begin; i < end; ++i) {
      slam_.addOdometry({SquareDrive::stampAt(i) + pause, T_zero_odom * SquareDrive::odometryAt(i)});
      slam_.addDetections(SquareDrive::stampAt(i) + pause - 30000000, drive_.detectionsAt(i));
    }
  }

  SquareDrive drive_;
  Slam slam_;
};

TEST_P(SessionsTest, OdometryThatIsSetToZeroIsAnotherSessionThatIsFoundInTheMap) {
  feed(0, 540, Pose::identity());
  feed(540, 700, SquareDrive::odometryAt(540).inverse());
  slam_.finish();
  ASSERT_EQ(slam_.parts().sessions.summary(slam_.map()).size(), 2U);
  EXPECT_EQ(slam_.parts().sessions.summary(slam_.map())[1].begin, SquareDrive::stampAt(540));
  EXPECT_TRUE(slam_.parts().sessions.summary(slam_.map())[1].is_located);
  const auto trajectory = trajectoryOf(slam_);
  ASSERT_EQ(trajectory.size(), 700U);
  const Pose& there = trajectory[200].T_world_base;
  EXPECT_LT((trajectory[680].T_world_base.translation_m - there.translation_m).head<2>().norm(), 1.0);
}

TEST_P(SessionsTest, OneSampleThatNoMotionLeadsToIsLeftOut) {
  feed(0, 100, Pose::identity());
  const Pose far{Eigen::Quaterniond::Identity(), {500.0, 0.0, 0.0}};
  EXPECT_FALSE(slam_.addOdometry({SquareDrive::stampAt(99) + 50000000, far * SquareDrive::odometryAt(99)}));
  feed(100, 200, Pose::identity());
  EXPECT_FALSE(slam_.addOdometry({SquareDrive::stampAt(199) + 50000000, Pose::identity()})) << "nor one set to zero";
  feed(200, 220, Pose::identity());
  EXPECT_EQ(slam_.parts().sessions.summary(slam_.map()).size(), 1U);
  EXPECT_EQ(slam_.parts().assembler.counters().odometry_outliers, 2U);
  EXPECT_EQ(slam_.parts().assembler.counters().frames, 219U) << "all but the newest, which waits";
  EXPECT_TRUE(latestCovOf(slam_));
}

TEST_P(SessionsTest, ADriveIsOneSession) {
  feed(0, 300, Pose::identity());
  feed(300, 320, Pose::identity(), 20000000000);
  EXPECT_EQ(slam_.parts().sessions.summary(slam_.map()).size(), 1U);
}

TEST_P(SessionsTest, StandingIsNotMapped) {
  feed(0, 40, Pose::identity());
  for (int i = 1; i <= 1000; ++i) {
    const Stamp stamp = SquareDrive::stampAt(39) + i * 100000000LL;
    slam_.addOdometry({stamp, SquareDrive::odometryAt(39)});
    slam_.addDetections(stamp - 30000000, drive_.detectionsAt(39));
  }
  EXPECT_GT(slam_.parts().assembler.counters().frames_standing, 600U);
  EXPECT_LT(slam_.parts().sessions.odometry().size(), 350U) << "beginning and end of the stand-still";
  EXPECT_EQ(trajectoryOf(slam_).back().stamp, SquareDrive::stampAt(39) + 100000000000LL);
  feed(40, 100, Pose::identity(), 101000000000);
  EXPECT_EQ(slam_.parts().sessions.summary(slam_.map()).size(), 1U);
  slam_.finish();
  EXPECT_GT(landmarksOf(slam_).size(), 50U);
}

INSTANTIATE_TEST_SUITE_P(Seeds, SessionsTest, testing::Values(1, 2));

/// The same drive in metres of another length.
class SmallWorldTest : public testing::TestWithParam<double> {};

TEST_P(SmallWorldTest, AMapComesWhateverTheSize) {
  const double size = GetParam();
  const SquareDrive drive(3);
  std::vector<ClassInfo> infos = makeStreetClasses().all();
  for (ClassInfo& info : infos) {
    info.range_stddev_m *= size;
    info.lateral_stddev_m *= size;
  }
  SlamConfig config = defaultsOf(Method::kDpmhm);
  config.mapper.calibration.min_stddev_m *= size;
  Slam slam(config, ClassTable(infos, "test"));
  for (int i = 0; i < 620; ++i) {
    StampedPose odometry{SquareDrive::stampAt(i), SquareDrive::odometryAt(i)};
    odometry.T_world_base.translation_m *= size;
    slam.addOdometry(odometry);
    Detections detections = drive.detectionsAt(i);
    for (Detection& detection : detections) detection.position_m *= size;
    slam.addDetections(odometry.stamp - 30000000, detections);
  }
  slam.finish();
  EXPECT_NEAR(static_cast<double>(landmarksOf(slam).size()), 160.0, 12.0);
  int accepted = 0;
  for (const LoopClosureRecord& record : slam.map().closures()) accepted += record.is_accepted ? 1 : 0;
  EXPECT_GT(accepted, 5);
}

INSTANTIATE_TEST_SUITE_P(Sizes, SmallWorldTest, testing::Values(1.0, 0.25, 0.0625));

}  // namespace
}  // namespace semantic_mht_slam
