#include "semantic_mht_slam/slam/trajectory_record.h"

#include <gtest/gtest.h>

#include "semantic_mht_slam/slam/slam.h"

#include "support/square_drive.h"

namespace semantic_mht_slam {
namespace {

StampedPose sampleAt(Stamp stamp, double x_m) {
  return {stamp, {Eigen::Quaterniond::Identity(), {x_m, 0.0, 0.0}}};
}

/// Seen at odometry x, found at x and y of the map.
MapFix fixAt(Stamp stamp, double x_m, double map_x_m, double map_y_m) {
  return {stamp, sampleAt(stamp, x_m).T_world_base, {Eigen::Quaterniond::Identity(), {map_x_m, map_y_m, 0.0}}};
}

TEST(TrajectoryRecordTest, EachSessionPassesThroughItsOwnFixes) {
  TrajectoryRecord record;
  for (const double x_m : {0.0, 1.0, 2.0}) record.odometry.push_back(sampleAt(static_cast<Stamp>(x_m), x_m));
  for (const double x_m : {0.0, 1.0}) record.odometry.push_back(sampleAt(static_cast<Stamp>(x_m), x_m));
  record.odometry.push_back(sampleAt(7, 5.0));
  record.sessions = {{0, {fixAt(2, 2.0, 3.0, 0.0), fixAt(0, 0.0, 0.0, 0.0), fixAt(0, 0.0, 9.0, 9.0)}},
                     {3, {fixAt(1, 1.0, 1.0, 4.0)}},
                     {5, {}}};
  const std::vector<StampedPose> trajectory = trajectoryOf(record);
  ASSERT_EQ(trajectory.size(), 6U);
  const std::vector<Eigen::Vector3d> expected_m = {{0, 0, 0}, {1.5, 0, 0}, {3, 0, 0}, {0, 4, 0}, {1, 4, 0}, {5, 0, 0}};
  for (std::size_t i = 0; i < expected_m.size(); ++i) {
    EXPECT_EQ(trajectory[i].stamp, record.odometry[i].stamp);
    EXPECT_LT((trajectory[i].T_world_base.translation_m - expected_m[i]).norm(), 1e-12) << i;
  }
}

TEST(TrajectoryRecordTest, ARecordGivesTheTrajectoryOfItsMomentHoweverTheEstimatorGoesOn) {
  const SquareDrive drive(1);
  Slam slam(defaultsOf(Method::kDpmhm), makeStreetClasses());
  drive.feed(slam, 0, 450);
  const std::vector<StampedPose> before = trajectoryOf(slam);
  const TrajectoryRecord record = trajectoryRecordOf(slam);
  drive.feed(slam, 450, 640);
  const std::vector<StampedPose> trajectory = trajectoryOf(record);
  ASSERT_EQ(trajectory.size(), before.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    ASSERT_EQ(trajectory[i].T_world_base.matrix(), before[i].T_world_base.matrix()) << i;
  }
  EXPECT_NE(trajectoryOf(slam)[449].T_world_base.matrix(), before[449].T_world_base.matrix())
      << "was not corrected since";
}

}  // namespace
}  // namespace semantic_mht_slam
