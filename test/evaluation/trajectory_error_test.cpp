#include "semantic_mht_slam/evaluation/trajectory_error.h"

#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "semantic_mht_slam/io/trajectory_file.h"

namespace semantic_mht_slam {
namespace {

constexpr double kPi = 3.14159265358979323846;

Pose turned(double yaw_rad, const Eigen::Vector3d& translation_m = Eigen::Vector3d::Zero()) {
  return {expRotation({0.0, 0.0, yaw_rad}), translation_m};
}

/// A metre a frame along x.
std::vector<Pose> straightDrive(int frames) {
  std::vector<Pose> poses;
  for (int i = 0; i < frames; ++i) poses.push_back(turned(0.0, {static_cast<double>(i), 0.0, 0.0}));
  return poses;
}

/// Rounds on a circle, a metre a frame, heading along the circle.
std::vector<Pose> roundDrive(int frames, int frames_a_round) {
  const double radius_m = frames_a_round / (2.0 * kPi);
  std::vector<Pose> poses;
  for (int i = 0; i < frames; ++i) {
    const double angle_rad = 2.0 * kPi * i / frames_a_round;
    poses.push_back(
        turned(angle_rad + 0.5 * kPi, {radius_m * std::cos(angle_rad), radius_m * std::sin(angle_rad), 0.0}));
  }
  return poses;
}

std::vector<Pose> moved(const Pose& motion, std::vector<Pose> poses) {
  for (Pose& pose : poses) pose = motion * pose;
  return poses;
}

std::vector<Pose> scaled(double factor, std::vector<Pose> poses) {
  for (Pose& pose : poses) pose.translation_m *= factor;
  return poses;
}

TEST(TrajectoryErrorTest, IsZeroForTheTruth) {
  const std::vector<Pose> truth = roundDrive(700, 300);
  const TrajectoryError error = trajectoryError(truth, truth);
  for (const double value : {error.first_m, error.se3_m, error.running_mean_m, error.running_std_m, error.t_rel_percent,
                             error.revisit_m, error.end_m}) {
    EXPECT_NEAR(value, 0.0, 1e-10);
  }
  EXPECT_NEAR(error.r_rel_deg_per_100m, 0.0, 1e-5);  // the arc cosine loses half of the digits near 1
}

TEST(TrajectoryErrorTest, DoesNotSeeARigidMotionOfTheEstimate) {
  const std::vector<Pose> truth = roundDrive(700, 300);
  const Pose motion{expRotation({0.3, -0.2, 1.0}), {100.0, -5.0, 7.0}};
  const TrajectoryError error = trajectoryError(truth, moved(motion, truth));
  EXPECT_NEAR(error.first_m, 0.0, 1e-9);
  EXPECT_NEAR(error.se3_m, 0.0, 1e-9);
  EXPECT_NEAR(error.t_rel_percent, 0.0, 1e-9);
  EXPECT_NEAR(error.revisit_m, 0.0, 1e-9);
}

TEST(TrajectoryErrorTest, AnOffsetAfterTheFirstFrameIsTheUnalignedError) {
  const std::vector<Pose> truth = straightDrive(10);
  std::vector<Pose> estimate = truth;
  for (std::size_t i = 1; i < estimate.size(); ++i) estimate[i].translation_m.y() += 2.0;
  const TrajectoryError error = trajectoryError(truth, estimate);
  EXPECT_NEAR(error.first_m, std::sqrt(9.0 * 4.0 / 10.0), 1e-12);
  EXPECT_NEAR(error.end_m, 2.0, 1e-12);
  EXPECT_LT(error.se3_m, 0.5 * error.first_m);
}

TEST(TrajectoryErrorTest, AWrongFirstHeadingTurnsTheWholeDrive) {
  const std::vector<Pose> truth = straightDrive(101);
  std::vector<Pose> estimate = truth;
  estimate.front().rotation = turned(-0.1).rotation;
  const TrajectoryError error = trajectoryError(truth, estimate);
  EXPECT_NEAR(error.end_m, 100.0 * 2.0 * std::sin(0.05), 1e-9);
  EXPECT_NEAR(error.se3_m, 0.0, 1e-9);
}

TEST(TrajectoryErrorTest, ScaleDriftIsTheTranslationErrorInPercent) {
  const std::vector<Pose> truth = straightDrive(1001);
  const TrajectoryError error = trajectoryError(truth, scaled(1.02, truth));
  EXPECT_NEAR(error.t_rel_percent, 2.0, 1e-9);
  EXPECT_NEAR(error.r_rel_deg_per_100m, 0.0, 1e-9);
  EXPECT_NEAR(error.end_m, 20.0, 1e-9);
  EXPECT_NEAR(error.first_m, 0.02 * std::sqrt(1000.0 * 2001.0 / 6.0), 1e-9);  // errors 0, 0.02, ... 20 m
  EXPECT_TRUE(std::isnan(error.revisit_m));
}

TEST(TrajectoryErrorTest, SteadyYawDriftIsTheRotationError) {
  const std::vector<Pose> truth = straightDrive(1001);
  std::vector<Pose> estimate = truth;
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    estimate[i].rotation = turned(static_cast<double>(i) * 0.01 * kPi / 180.0).rotation;
  }
  EXPECT_NEAR(trajectoryError(truth, estimate).r_rel_deg_per_100m, 1.0, 1e-6);
}

TEST(TrajectoryErrorTest, RelativeErrorsNeedAHundredMetres) {
  const std::vector<Pose> long_enough = straightDrive(101);
  const std::vector<Pose> too_short = straightDrive(100);
  EXPECT_NEAR(trajectoryError(long_enough, scaled(0.95, long_enough)).t_rel_percent, 5.0, 1e-9);
  EXPECT_TRUE(std::isnan(trajectoryError(too_short, too_short).t_rel_percent));
  EXPECT_TRUE(std::isnan(trajectoryError(too_short, too_short).r_rel_deg_per_100m));
}

TEST(TrajectoryErrorTest, RevisitErrorIsTheGapAtTheSamePlace) {
  const std::vector<Pose> truth = roundDrive(600, 300);
  std::vector<Pose> estimate = truth;
  for (std::size_t i = 300; i < estimate.size(); ++i) estimate[i].translation_m.z() += 1.5;
  EXPECT_NEAR(trajectoryError(truth, estimate).revisit_m, 1.5, 1e-9);
}

TEST(TrajectoryErrorTest, VisitsWithinTwoHundredFramesAreNoRevisits) {
  const std::vector<Pose> truth = roundDrive(390, 195);  // each place again after 195 frames
  EXPECT_TRUE(std::isnan(trajectoryError(truth, truth).revisit_m));
}

TEST(TrajectoryErrorTest, RevisitErrorIsTheSameInCameraAxes) {
  const std::vector<Pose> truth = roundDrive(600, 300);
  const std::vector<Pose> estimate = scaled(1.01, truth);
  const Pose T_camera_world{Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5), Eigen::Vector3d::Zero()};
  const double expected = trajectoryError(truth, estimate).revisit_m;
  EXPECT_NEAR(trajectoryError(moved(T_camera_world, truth), moved(T_camera_world, estimate)).revisit_m, expected, 1e-9);
  EXPECT_GT(expected, 0.0);
}

TEST(TrajectoryErrorTest, ARobotThatStandsStillForHoursIsScored) {
  const std::vector<Pose> truth(14000, Pose::identity());
  EXPECT_EQ(trajectoryError(truth, truth).revisit_m, 0.0);
}

TEST(TrajectoryErrorTest, OnePoseHasNoErrorAndNoRelativeError) {
  const TrajectoryError error = trajectoryError({turned(1.0, {1.0, 2.0, 3.0})}, {turned(0.0)});
  EXPECT_NEAR(error.first_m, 0.0, 1e-12);
  EXPECT_NEAR(error.se3_m, 0.0, 1e-12);
  EXPECT_NEAR(error.running_std_m, 0.0, 1e-12);
  EXPECT_TRUE(std::isnan(error.t_rel_percent));
  EXPECT_TRUE(std::isnan(error.revisit_m));
}

TEST(TrajectoryErrorTest, RefusesTrajectoriesThatCannotBeCompared) {
  const std::vector<Pose> two = straightDrive(2);
  std::vector<Pose> broken = two;
  broken[1].translation_m.x() = std::nan("");
  EXPECT_THROW(trajectoryError(two, straightDrive(3)), std::invalid_argument);
  EXPECT_THROW(trajectoryError(two, {}), std::invalid_argument);
  EXPECT_THROW(trajectoryError(std::vector<Pose>{}, std::vector<Pose>{}), std::invalid_argument);
  EXPECT_THROW(trajectoryError(two, broken), std::invalid_argument);
  EXPECT_THROW(trajectoryError(broken, two), std::invalid_argument);
}

TEST(TrajectoryErrorTest, RunningRmseIsTheRmseSoFar) {
  const std::vector<double> running = runningRmse({3.0, 4.0, 0.0});
  ASSERT_EQ(running.size(), 3U);
  EXPECT_DOUBLE_EQ(running[0], 3.0);
  EXPECT_DOUBLE_EQ(running[1], std::sqrt(12.5));
  EXPECT_DOUBLE_EQ(running[2], std::sqrt(25.0 / 3.0));
  EXPECT_TRUE(runningRmse({}).empty());
}

TEST(TrajectoryErrorTest, FrameErrorsBelongToTheSummary) {
  const std::vector<Pose> truth = roundDrive(300, 250);
  const std::vector<Pose> estimate = scaled(1.1, truth);
  const FrameErrors frames = frameErrors(poseMatrices(truth), poseMatrices(estimate));
  const TrajectoryError error = trajectoryError(truth, estimate);
  EXPECT_EQ(frames.unaligned_m.front(), 0.0);
  EXPECT_EQ(frames.unaligned_m.back(), error.end_m);
  EXPECT_DOUBLE_EQ(frames.running_rmse_m.back(), error.first_m);
  EXPECT_DOUBLE_EQ(runningRmse(frames.aligned_m).back(), error.se3_m);
}

TEST(TrajectoryErrorTest, PathLengthAddsTheSteps) {
  EXPECT_DOUBLE_EQ(pathLength(poseMatrices(straightDrive(11))), 10.0);
  EXPECT_EQ(pathLength({}), 0.0);
  EXPECT_TRUE(startingAt(PoseMatrix::Identity(), {}).empty());
}

/// Figures of a KITTI odometry, published with the data.
struct KnownError {
  const char* sequence;
  const char* file;
  double running_mean_m;
  double running_std_m;
  double se3_m;
};

class KittiTrajectoryErrorTest : public ::testing::TestWithParam<KnownError> {};

TEST_P(KittiTrajectoryErrorTest, EqualsThePublishedFigures) {
  const char* data = std::getenv("SEMANTIC_MHT_SLAM_DATA");
  if (data == nullptr || *data == '\0') GTEST_SKIP() << "SEMANTIC_MHT_SLAM_DATA names no data folder";
  const KnownError& known = GetParam();
  const std::string folder = std::string(data) + "/kitti/" + known.sequence + "/";
  const TrajectoryError error =
      trajectoryError(readKittiTrajectory(folder + "poses.txt"), readKittiTrajectory(folder + known.file));
  EXPECT_NEAR(error.running_mean_m, known.running_mean_m, 0.0051);
  EXPECT_NEAR(error.running_std_m, known.running_std_m, 0.0051);
  EXPECT_NEAR(error.se3_m, known.se3_m, 0.0051);
}

constexpr const char* kOrb = "odometry/vo_orb.txt";
constexpr const char* kDfvo = "odometry/vo_dfvo.txt";
constexpr const char* kSimple = "odometry/lo_simple.txt";
constexpr const char* kOrbSlam = "reference/slam_orbslam2_stereo.txt";
constexpr const char* kSuma = "reference/slam_suma.txt";

INSTANTIATE_TEST_SUITE_P(
    Odometries, KittiTrajectoryErrorTest,
    ::testing::Values(KnownError{"00", kOrb, 6.76, 1.53, 3.87}, KnownError{"05", kOrb, 3.00, 1.60, 2.06},
                      KnownError{"06", kOrb, 1.94, 0.74, 2.15}, KnownError{"07", kOrb, 1.50, 1.13, 1.50},
                      KnownError{"00", kDfvo, 13.20, 6.06, 11.34}, KnownError{"05", kDfvo, 4.92, 2.18, 3.63},
                      KnownError{"06", kDfvo, 3.65, 1.60, 2.53}, KnownError{"07", kDfvo, 2.06, 1.02, 1.72},
                      KnownError{"00", kSimple, 5.62, 2.51, 4.86}, KnownError{"05", kSimple, 1.87, 1.53, 2.29},
                      KnownError{"06", kSimple, 1.59, 0.52, 0.56}, KnownError{"07", kSimple, 0.76, 0.30, 0.78},
                      KnownError{"00", kOrbSlam, 6.62, 1.50, 1.35}, KnownError{"05", kOrbSlam, 1.10, 0.37, 0.78},
                      KnownError{"06", kOrbSlam, 2.21, 0.76, 0.71}, KnownError{"07", kOrbSlam, 0.71, 0.27, 0.54},
                      KnownError{"00", kSuma, 5.74, 1.51, 1.14}, KnownError{"05", kSuma, 0.97, 0.24, 0.67},
                      KnownError{"06", kSuma, 2.31, 0.81, 0.61}, KnownError{"07", kSuma, 0.43, 0.14, 0.36}));

}  // namespace
}  // namespace semantic_mht_slam
