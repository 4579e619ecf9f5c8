#include <cmath>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "semantic_mht_slam/slam/slam.h"

#include "support/square_drive.h"

namespace semantic_mht_slam {
namespace {

bool isPositiveDefinite(const FixedAxesCov& cov) {
  return cov.allFinite() && cov.isApprox(cov.transpose(), 1e-9) && cov.llt().info() == Eigen::Success;
}

double planarStddev_m(const FixedAxesCov& cov) {
  return std::sqrt(cov.topLeftCorner<2, 2>().trace());
}

Eigen::Matrix<double, 6, 1> errorOf(const Pose& estimate, const Pose& truth) {
  Eigen::Matrix<double, 6, 1> error;
  error << estimate.translation_m - truth.translation_m, logRotation(estimate.rotation * truth.rotation.conjugate());
  return error;
}

class PoseUncertaintyTest : public testing::TestWithParam<int> {
 protected:
  PoseUncertaintyTest()
      : drive_(static_cast<std::uint64_t>(GetParam())), slam_(defaultsOf(Method::kDpmhm), makeStreetClasses()) {}

  double newest_m() const { return planarStddev_m(*latestCovOf(slam_)); }

  SquareDrive drive_;
  Slam slam_;
};

TEST_P(PoseUncertaintyTest, ItGrowsFromTheFirstPoseOnAndShrinksWhereALoopCloses) {
  drive_.feed(slam_, 0, 1);
  EXPECT_LT(newest_m(), 0.01) << "the map begins here";
  double largest_m = 0.0;
  for (int i = 1; i < 480; ++i) {
    drive_.feed(slam_, i, i + 1);
    ASSERT_TRUE(isPositiveDefinite(*latestCovOf(slam_))) << i;
    largest_m = std::max(largest_m, newest_m());
  }
  EXPECT_GT(largest_m, 0.3);
  drive_.feed(slam_, 480, 600);
  EXPECT_LT(newest_m(), 0.7 * largest_m) << "seen again";
}

TEST_P(PoseUncertaintyTest, ItGrowsWhileNothingIsSeen) {
  drive_.feed(slam_, 0, 200);
  double last_m = newest_m();
  for (int i = 200; i < 400; ++i) {
    slam_.addOdometry({SquareDrive::stampAt(i), SquareDrive::odometryAt(i)});
    if (i % 50 != 49) continue;
    EXPECT_GT(newest_m(), last_m) << i;
    last_m = newest_m();
  }
}

TEST_P(PoseUncertaintyTest, ErrorsAreAsLargeAsItSays) {
  drive_.feed(slam_, 0, 900);
  slam_.finish();
  const MapUncertainty uncertainty = uncertaintyOf(slam_);
  const std::vector<FixedAxesCov> covs = trajectoryCovOf(slam_, uncertainty);
  const std::vector<StampedPose> trajectory = trajectoryOf(slam_);
  ASSERT_EQ(covs.size(), trajectory.size());
  const Pose T_truth_map = drive_.truthAt(0) * trajectory[0].T_world_base.inverse();
  double squares = 0.0;
  for (int i = 1; i < 900; ++i) {
    const auto row = static_cast<std::size_t>(i);
    ASSERT_TRUE(isPositiveDefinite(covs[row])) << i;
    const auto error = errorOf(T_truth_map * trajectory[row].T_world_base, drive_.truthAt(i));
    squares += error.dot(covs[row].ldlt().solve(error)) / 899.0;
  }
  // Poses of one drive err alike, so that the mean spreads like a single value; odometry without noise errs little.
  EXPECT_LT(squares, 22.5) << "99.9 % of the chi-square distribution of 6";
  for (const MixtureLandmark& landmark : landmarksOf(slam_, uncertainty)) {
    EXPECT_TRUE(isCovariance(landmark.position.cov_m2)) << landmark.id;
    EXPECT_LT(landmark.position.cov_m2.trace(), 25.0) << landmark.id;
  }
}

TEST_P(PoseUncertaintyTest, LandmarksHoldTheUncertaintyOfThePoseThatSawThem) {
  drive_.feed(slam_, 0, 300);
  slam_.finish();
  double near_m2 = 0.0;
  double far_m2 = 0.0;
  for (const MixtureLandmark& landmark : landmarksOf(slam_)) {
    const double variance_m2 = landmark.position.cov_m2(0, 0) + landmark.position.cov_m2(1, 1);
    const double from_start_m = landmark.position.mean_m.head<2>().norm();
    if (from_start_m < 20.0) near_m2 = std::max(near_m2, variance_m2);
    if (from_start_m > 130.0) far_m2 = std::max(far_m2, variance_m2);
  }
  EXPECT_GT(near_m2, 0.0);
  EXPECT_GT(far_m2, 2.0 * near_m2);
}

TEST_P(PoseUncertaintyTest, ALostVehicleHasNoneAndOneThatIsFoundHas) {
  drive_.feed(slam_, 0, 500);
  slam_.finish();
  slam_.localize();
  const double before_m = newest_m();
  EXPECT_GT(before_m, 0.0);
  slam_.beginSession();
  const auto feed = [&](int i) {
    slam_.addOdometry({SquareDrive::stampAt(i), SquareDrive::odometryAt(100).inverse() * SquareDrive::odometryAt(i)});
    slam_.addDetections(SquareDrive::stampAt(i) - 30000000, drive_.detectionsAt(i));
  };
  feed(100);
  EXPECT_FALSE(latestCovOf(slam_).has_value());
  int i = 101;
  while (!isLocated(slam_.mode()) && i < 160) feed(i++);
  ASSERT_TRUE(isLocated(slam_.mode()));
  ASSERT_TRUE(latestCovOf(slam_).has_value());
  EXPECT_LT(newest_m(), 3.0);
  slam_.beginSession();
  feed(100);
  ASSERT_TRUE(slam_.expectAt(trajectoryOf(slam_)[100].T_world_base, 2.0));
  EXPECT_NEAR(newest_m(), 2.0 * std::sqrt(2.0), 0.01) << "as it was told";
  const std::vector<FixedAxesCov> covs = trajectoryCovOf(slam_, uncertaintyOf(slam_));
  EXPECT_GE(covs.back()(0, 0), 1e6) << "the new session has no fix yet";
}

INSTANTIATE_TEST_SUITE_P(Seeds, PoseUncertaintyTest, testing::Values(1, 2));

}  // namespace
}  // namespace semantic_mht_slam
