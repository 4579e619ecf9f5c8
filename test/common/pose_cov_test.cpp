#include "semantic_mht_slam/common/pose_cov.h"

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "semantic_mht_slam/common/random.h"

namespace semantic_mht_slam {
namespace {

TEST(PoseCovTest, FixedAxesAreThoseOfTheFrameThatThePoseIsIn) {
  const Pose quarter_turn{expRotation({0.0, 0.0, 0.5 * M_PI}), {5.0, 6.0, 7.0}};
  PoseCov cov = PoseCov::Zero();
  cov.diagonal() << 4.0, 1.0, 9.0, 0.4, 0.1, 0.9;  // along, across, up; roll, pitch, heading
  const FixedAxesCov fixed = inFixedAxes(quarter_turn, cov);
  const Eigen::Matrix<double, 6, 1> diagonal = fixed.diagonal();
  EXPECT_NEAR(diagonal[0], 1.0, 1e-12);
  EXPECT_NEAR(diagonal[1], 4.0, 1e-12) << "along the base's x axis is along y of the map";
  EXPECT_NEAR(diagonal[2], 9.0, 1e-12);
  EXPECT_NEAR(diagonal[3], 0.1, 1e-12);
  EXPECT_NEAR(diagonal[4], 0.4, 1e-12);
  EXPECT_NEAR(diagonal[5], 0.9, 1e-12);
}

TEST(PoseCovTest, ErrorsOnTheRightHaveTheCovarianceInFixedAxes) {
  const Pose pose{expRotation({0.3, -0.4, 1.2}), {5.0, 6.0, 7.0}};
  Rng rng(3);
  PoseCov root = PoseCov::Zero();
  for (int i = 0; i < 6; ++i) {
    for (int k = 0; k <= i; ++k) root(i, k) = (i < 3 ? 0.3 : 0.02) * rng.normal();
    root(i, i) += i < 3 ? 0.5 : 0.03;
  }
  const FixedAxesCov cov = inFixedAxes(pose, PoseCov(root * root.transpose()));
  double sum = 0.0;
  constexpr int kErrors = 3000;
  for (int n = 0; n < kErrors; ++n) {
    Eigen::Matrix<double, 6, 1> step;
    for (int i = 0; i < 6; ++i) step[i] = rng.normal();
    step = (root * step).eval();
    const Pose wrong = pose * Pose{expRotation(step.tail<3>()), step.head<3>()};
    Eigen::Matrix<double, 6, 1> error;
    error << wrong.translation_m - pose.translation_m, logRotation(wrong.rotation * pose.rotation.conjugate());
    sum += error.dot(cov.ldlt().solve(error));
  }
  EXPECT_NEAR(sum / kErrors, 6.0, 0.3);
}

TEST(PoseCovTest, AnErrorOfTheRotationSwingsWhatHangsOnThePose) {
  FixedAxesCov cov = FixedAxesCov::Zero();
  cov(5, 5) = 0.01;
  const FixedAxesCov there = carried(cov, {10.0, 0.0, 0.0});
  EXPECT_NEAR(there(1, 1), 1.0, 1e-12);
  EXPECT_NEAR(there(1, 5), 0.1, 1e-12) << "turned to the left, it lies further left";
  EXPECT_NEAR(there(0, 0), 0.0, 1e-12);
}

TEST(PoseCovTest, UnknownIsLargeAndPositiveDefinite) {
  EXPECT_GE(unknownPoseCov().diagonal().minCoeff(), 1e6);
  EXPECT_EQ(unknownPoseCov().llt().info(), Eigen::Success);
}

}  // namespace
}  // namespace semantic_mht_slam
