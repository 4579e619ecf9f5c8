#include "semantic_mht_slam/io/trajectory_file.h"

#include <cmath>

#include <gtest/gtest.h>

#include "semantic_mht_slam/common/random.h"
#include "semantic_mht_slam/io/text_file.h"

#include "support/expect_input_error.h"
#include "support/temporary_folder.h"

namespace semantic_mht_slam {
namespace {

std::vector<StampedPose> randomTrajectory() {
  Rng rng(1);
  std::vector<StampedPose> trajectory;
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector3d axis_angle(rng.normal(), rng.normal(), rng.normal());
    trajectory.push_back(
        {100000001LL * i, {expRotation(axis_angle), {rng.normal(), rng.normal(), 1e3 * rng.normal()}}});
  }
  return trajectory;
}

class TrajectoryFileTest : public ::testing::Test {
 protected:
  void write(const std::string& content) { writeFileAtomically(path_, content); }

  const TemporaryFolder folder_;
  const std::string path_ = folder_ / "poses.txt";
};

TEST_F(TrajectoryFileTest, TumComesBackBitForBit) {
  const std::vector<StampedPose> trajectory = randomTrajectory();
  write(formatTumTrajectory(trajectory));
  const std::vector<StampedPose> read = readTumTrajectory(path_);
  ASSERT_EQ(read.size(), trajectory.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_EQ(read[i].stamp, trajectory[i].stamp);
    EXPECT_EQ(read[i].T_world_base.translation_m, trajectory[i].T_world_base.translation_m);
    EXPECT_EQ(read[i].T_world_base.rotation.coeffs(), trajectory[i].T_world_base.rotation.coeffs());
  }
}

TEST_F(TrajectoryFileTest, KittiComesBackWithinRounding) {
  std::vector<Pose> poses;
  for (const StampedPose& pose : randomTrajectory()) poses.push_back(pose.T_world_base);
  write(formatKittiTrajectory(poses));
  const std::vector<Pose> read = readKittiTrajectory(path_);
  ASSERT_EQ(read.size(), poses.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_EQ(read[i].translation_m, poses[i].translation_m);
    EXPECT_LT(angularDistance(read[i].rotation, poses[i].rotation), 1e-14);
  }
}

TEST_F(TrajectoryFileTest, TimesComeBackToTheNanosecond) {
  write(formatTimes({0, 103735900, 1234567890123456789}));
  EXPECT_EQ(readTimes(path_)[1], 103735900);
}

TEST_F(TrajectoryFileTest, BadRowsAreNamedByFileAndLine) {
  const std::string good = "1 0 0 0 0 1 0 0 0 0 1 0\n";
  write(good + "1 0 0 0 0 1 0 0 0 0 1\n");
  expectInputError([&] { readKittiTrajectory(path_); }, {"poses.txt:2", "11 numbers, 12 were expected"});
  write(good + good + "1 0 0 nan 0 1 0 0 0 0 1 0\n");
  expectInputError([&] { readKittiTrajectory(path_); }, {"poses.txt:3", "'nan' (number 4)"});
  write("1 0 0 x 0 1 0 0 0 0 1 0\n");
  expectInputError([&] { readKittiTrajectory(path_); }, {"poses.txt:1", "'x' (number 4)"});
  write("2 0 0 0 0 1 0 0 0 0 1 0\n");
  expectInputError([&] { readKittiTrajectory(path_); }, {"poses.txt:1", "no rotation"});
  write("");
  expectInputError([&] { readKittiTrajectory(path_); }, {"poses.txt", "empty"});
  write("1.0 0 0 0 0 0 0 1\n1.0 0 0 0 0 0 0 1\n");
  expectInputError([&] { readTumTrajectory(path_); }, {"poses.txt:2", "does not come after"});
  write("1.0 0 0 0 0 0 0 2\n");
  expectInputError([&] { readTumTrajectory(path_); }, {"poses.txt:1", "unit norm"});
  write("1 0 0 1e308 0 1 0 0 0 0 1 0\n");
  expectInputError([&] { readKittiTrajectory(path_); }, {"poses.txt:1", "beyond"});
  write("0.0\n5e9\n");
  expectInputError([&] { readTimes(path_); }, {"poses.txt:2", "outside 0 to 4e9"});
  write("0.0\n0.1\n0.05\n");
  expectInputError([&] { readTimes(path_); }, {"poses.txt:3", "does not come after"});
}

}  // namespace
}  // namespace semantic_mht_slam
