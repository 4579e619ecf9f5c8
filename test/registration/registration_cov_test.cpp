#include <optional>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "semantic_mht_slam/registration/registration.h"

#include "registration/registration_test_util.h"

namespace semantic_mht_slam {
namespace {

using namespace testing;  // NOLINT(google-build-using-namespace): the worlds of these tests

/// How the points of simulated pairs of sets err.
struct Errors {
  double b_stddev_m = 0.15;
  double a_stddev_m = 0.15;
  bool is_a_common = false;  ///< one error for all points of a
  bool has_prior = true;
};

/// Mean normalised squared errors of the first mode; expected: the degrees of freedom.
struct Consistency {
  double pose = 0.0;  ///< 6
  double yaw = 0.0;   ///< 1
  int found = 0;
};

Consistency consistencyOf(const Errors& errors, int runs) {
  RegistrationConfig config;
  config.noise_floor_m = 1e-3;
  config.height_stddev_m = 0.0;
  Consistency mean;
  for (int seed = 0; seed < runs; ++seed) {
    World w = world(static_cast<std::uint64_t>(seed), errors.b_stddev_m);
    Rng rng(static_cast<std::uint64_t>(seed) + 31);
    const double tilt_rad = config.tilt_stddev_rad;
    const Pose T_level_b{expRotation({rng.normal(0.0, tilt_rad), rng.normal(0.0, tilt_rad), 0.0}), {0.0, 0.0, 0.0}};
    w.detections = moved(w.detections, T_level_b.inverse());
    w.T_a_b = w.T_a_b * T_level_b;
    if (!errors.has_prior) {  // two places as two keyframes have them
      w.landmarks = moved(w.landmarks, {Eigen::Quaterniond::Identity(), -w.T_a_b.translation_m});
      w.T_a_b.translation_m.setZero();
    }
    Eigen::Vector3d error_m = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < w.landmarks.size(); ++i) {
      if (i == 0 || !errors.is_a_common) {
        error_m = errors.a_stddev_m * Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal());
      }
      w.landmarks[i].position_m += error_m;
      w.landmarks[i].cov_m2 = errors.a_stddev_m * errors.a_stddev_m * Eigen::Matrix3d::Identity();
      w.detections[i].cov_m2 = errors.b_stddev_m * errors.b_stddev_m * Eigen::Matrix3d::Identity();
      w.landmarks[i].class_index = w.detections[i].class_index = static_cast<ClassIndex>(i % 2);  // Dirac classes
    }
    const std::optional<RegistrationPrior> prior = errors.has_prior ? std::optional(w.prior) : std::nullopt;
    const auto found = align(w.landmarks, w.detections, prior, classTable(), config);
    if (found.empty()) continue;
    const auto error = errorOf(found[0].T_a_b, w.T_a_b);
    ++mean.found;
    mean.pose += error.dot(found[0].cov.ldlt().solve(error)) / runs;
    mean.yaw += error(5) * error(5) / found[0].cov(5, 5) / runs;
  }
  return mean;
}

class RegistrationConsistencyTest : public ::testing::TestWithParam<bool> {};

TEST_P(RegistrationConsistencyTest, StatesErrorsAsTheyAre) {
  constexpr int kRuns = 100;  // of 6 degrees of freedom: chi-square 99 % bounds [5.15, 6.94]; of 1: [0.67, 1.40]
  const bool has_prior = GetParam();
  const Consistency precise = consistencyOf({0.15, 0.005, false, has_prior}, kRuns);
  EXPECT_EQ(precise.found, kRuns);
  EXPECT_GT(precise.pose, 5.15);
  EXPECT_LT(precise.pose, 6.94);
  EXPECT_GT(precise.yaw, 0.67);
  EXPECT_LT(precise.yaw, 1.40);
}

TEST_P(RegistrationConsistencyTest, HoldsWhetherThePointsOfAMapErrAlikeOrNot) {
  constexpr int kRuns = 100;
  for (const bool is_common : {false, true}) {
    const Consistency found = consistencyOf({0.15, 0.15, is_common, GetParam()}, kRuns);
    EXPECT_EQ(found.found, kRuns);
    EXPECT_GT(found.pose, 0.5 * 6.0) << "common " << is_common;  // cautious: it must hold in both cases
    EXPECT_LT(found.pose, 1.1 * 6.0) << "common " << is_common;
    EXPECT_GT(found.yaw, 0.4) << "common " << is_common;
    EXPECT_LT(found.yaw, 1.4) << "common " << is_common;
  }
}

INSTANTIATE_TEST_SUITE_P(WithAndWithoutPrior, RegistrationConsistencyTest, ::testing::Bool());

TEST(RegistrationCovTest, IsNeverMoreCertainThanTheLandmarks) {
  for (const double stddev_m : {0.05, 0.3, 1.0}) {
    World w = world(6, 0.0, 40);
    const Eigen::Matrix3d cov_m2 = Eigen::Vector3d(stddev_m, 2.0 * stddev_m, stddev_m).cwiseAbs2().asDiagonal();
    for (RegistrationPoint& landmark : w.landmarks) landmark.cov_m2 = cov_m2;
    const auto found = align(w);
    ASSERT_FALSE(found.empty());
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(found[0].headingCov().topLeftCorner<3, 3>() - cov_m2);
    EXPECT_GE(eigen.eigenvalues()(0), -1e-9);
  }
}

TEST(RegistrationCovTest, TheHeadingCovarianceIsThePartOfTheStepAboutTheVertical) {
  RegistrationMode mode;
  mode.T_a_b.rotation = expRotation({0.0, 0.0, 1.0});
  mode.cov = Eigen::Matrix<double, 6, 1>(0.04, 0.01, 0.09, 0.5, 0.6, 0.0004).asDiagonal();
  mode.cov(0, 5) = mode.cov(5, 0) = 0.001;
  const Eigen::Matrix4d cov = mode.headingCov();
  EXPECT_NEAR(cov(3, 3), 0.0004, 1e-12);
  EXPECT_NEAR(cov(2, 2), 0.09, 1e-12);
  EXPECT_NEAR(cov(0, 0), 0.04 * std::pow(std::cos(1.0), 2) + 0.01 * std::pow(std::sin(1.0), 2), 1e-12);
  EXPECT_NEAR(cov(0, 3), 0.001 * std::cos(1.0), 1e-12);
  EXPECT_NEAR(cov(1, 3), 0.001 * std::sin(1.0), 1e-12);
}

}  // namespace
}  // namespace semantic_mht_slam
