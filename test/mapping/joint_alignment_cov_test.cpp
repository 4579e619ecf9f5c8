#include <limits>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "semantic_mht_slam/mapping/joint_alignment.h"

#include "mapping/joint_alignment_test_util.h"

namespace semantic_mht_slam {
namespace {

using namespace testing;  // NOLINT(google-build-using-namespace): the worlds of these tests

/// Mean normalised squared error of the first hypothesis when points err by what their covariances say. The landmarks'
/// errors are drawn for each of them, or once for all.
double meanNees(double detection_stddev_m, double landmark_stddev_m, bool is_common, int runs) {
  JointAlignmentConfig config;
  config.noise_floor_m = 1e-3;
  config.tilt_stddev_rad = 0.0;
  double sum = 0.0;
  for (int seed = 0; seed < runs; ++seed) {
    World w = world(static_cast<std::uint64_t>(seed), detection_stddev_m);
    Rng rng(static_cast<std::uint64_t>(seed) + 31);
    Eigen::Vector3d error_m = Eigen::Vector3d::Zero();
    for (int i = 0; i < 20; ++i) {
      if (i == 0 || !is_common) error_m = landmark_stddev_m * Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal());
      w.landmarks[i].position_m += error_m;
      w.landmarks[i].cov_m2 = landmark_stddev_m * landmark_stddev_m * Eigen::Matrix3d::Identity();
      w.detections[i].cov_m2 = detection_stddev_m * detection_stddev_m * Eigen::Matrix3d::Identity();
      w.landmarks[i].class_index = w.detections[i].class_index = i % 2;  // Dirac classes
    }
    const auto found = align(w, config);
    if (found.empty()) return std::numeric_limits<double>::quiet_NaN();
    const Eigen::Vector4d error = difference(found[0].T_a_b, w.T_a_b);
    sum += error.dot(found[0].cov.ldlt().solve(error));
  }
  return sum / runs;
}

TEST(JointAlignmentCovTest, StatesItsErrorsAsTheyAre) {
  // 100 runs of 4 degrees of freedom: chi-square 99 % bounds [3.32, 4.77]
  const double precise_landmarks = meanNees(0.15, 0.005, false, 100);
  EXPECT_GT(precise_landmarks, 3.32);
  EXPECT_LT(precise_landmarks, 4.77);
  const double common_errors = meanNees(0.15, 0.15, true, 100);
  EXPECT_GT(common_errors, 3.32);
  EXPECT_LT(common_errors, 4.77);
  EXPECT_LT(meanNees(0.15, 0.15, false, 100), 4.77);  // independent errors of landmarks: cautious
}

TEST(JointAlignmentCovTest, IsNeverMoreCertainThanTheLandmarks) {
  for (const double stddev_m : {0.05, 0.3, 1.0}) {
    World w = world(6, 0.0, 40);
    for (AlignmentPoint& landmark : w.landmarks) {
      landmark.cov_m2 = Eigen::Vector3d(stddev_m, 2.0 * stddev_m, stddev_m).cwiseAbs2().asDiagonal();
    }
    const auto found = align(w);
    ASSERT_FALSE(found.empty());
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> eigen(
        found[0].cov - Eigen::Vector4d(stddev_m * stddev_m, 4.0 * stddev_m * stddev_m, stddev_m * stddev_m, 0.0)
                           .asDiagonal()
                           .toDenseMatrix());
    EXPECT_GE(eigen.eigenvalues()(0), -1e-9);
  }
}

}  // namespace
}  // namespace semantic_mht_slam
