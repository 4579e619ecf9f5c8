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

TEST(TrajectoryRecordTest, CovariancesAreThoseOfTheFixesAndGrowAwayFromThem) {
  TrajectoryRecord record;
  for (int i = 0; i <= 40; ++i) record.odometry.push_back(sampleAt(i, i));
  for (int i = 0; i <= 20; ++i) record.odometry.push_back(sampleAt(i, i));
  for (int i = 0; i <= 5; ++i) record.odometry.push_back(sampleAt(i, i));
  const auto fix = [](int i, double variance_m2) {
    MapFix result = fixAt(i, i, i, 0.0);
    result.cov = variance_m2 * FixedAxesCov::Identity();
    result.cov.bottomRightCorner<3, 3>() *= 1e-4;
    return result;
  };
  record.sessions = {{0, {fix(10, 0.1), fix(20, 0.3)}}, {41, {fix(10, 0.2)}}, {62, {}}};
  const std::vector<FixedAxesCov> covs = trajectoryCovOf(record, OdometryModel{});
  ASSERT_EQ(covs.size(), record.odometry.size());
  EXPECT_LT(covs[0](0, 0), 1e-5) << "the map begins here";
  EXPECT_GT(covs[9](0, 0), covs[1](0, 0));
  EXPECT_NEAR(covs[10](0, 0), 0.1, 1e-9);
  EXPECT_NEAR(covs[15](0, 0), 0.2, 1e-9);
  EXPECT_NEAR(covs[20](0, 0), 0.3, 1e-9);
  EXPECT_GT(covs[40](0, 0), 0.4);
  EXPECT_NEAR(covs[51](0, 0), 0.2, 1e-9);
  EXPECT_GT(covs[41](0, 0), 0.25) << "before the first fix of a later session";
  EXPECT_GT(covs[61](0, 0), 0.25);
  EXPECT_GE(covs[62](0, 0), 1e6) << "never found in the map";
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
