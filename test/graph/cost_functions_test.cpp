#include "../../src/graph/cost_functions.h"

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include "semantic_mht_slam/common/random.h"

#include "../../src/graph/ceres_manifold.h"

namespace semantic_mht_slam {
namespace {

template <int kSize>
Eigen::Matrix<double, kSize, 1> randomVector(Rng& rng, double scale) {
  Eigen::Matrix<double, kSize, 1> vector;
  for (int i = 0; i < kSize; ++i) vector[i] = scale * rng.normal();
  return vector;
}

/// Symmetric, positive definite and far from diagonal.
template <int kSize>
Eigen::Matrix<double, kSize, kSize> randomCovariance(Rng& rng) {
  Eigen::Matrix<double, kSize, kSize> root;
  for (int i = 0; i < kSize; ++i) root.col(i) = randomVector<kSize>(rng, 1.0);
  return root * root.transpose() + 0.1 * Eigen::Matrix<double, kSize, kSize>::Identity();
}

Pose randomPose(Rng& rng) {
  return {expRotation(randomVector<3>(rng, 1.0)), randomVector<3>(rng, 5.0)};
}

Pose2 randomPose2(Rng& rng) {
  return {randomVector<2>(rng, 5.0), rng.uniform(-3.0, 3.0)};
}

template <int kVariables>
using Jet = ceres::Jet<double, kVariables>;

/// Error of a relative pose by its definition, for automatic differentiation by steps of both poses.
Eigen::Matrix<Jet<12>, 6, 1> automaticError(const Pose& from, const Pose& to, const Pose& measured) {
  using J = Jet<12>;
  using Vector = Eigen::Matrix<J, 3, 1>;
  const auto stepped = [](const Pose& pose, int first, Eigen::Quaternion<J>& rotation, Vector& translation) {
    const Eigen::Quaternion<J> step(J(1.0), J(0.0, first) * 0.5, J(0.0, first + 1) * 0.5, J(0.0, first + 2) * 0.5);
    rotation = pose.rotation.cast<J>() * step;  // Exp to first order, which is all a derivative at zero needs
    for (int i = 0; i < 3; ++i) translation[i] = J(pose.translation_m[i], first + 3 + i);
  };
  Eigen::Quaternion<J> q_from;
  Eigen::Quaternion<J> q_to;
  Vector t_from;
  Vector t_to;
  stepped(from, 0, q_from, t_from);
  stepped(to, 6, q_to, t_to);
  const Eigen::Quaternion<J> turn_back = measured.rotation.conjugate().cast<J>();
  const Vector t_measured = measured.translation_m.cast<J>();
  const Vector t_error = turn_back * Vector(q_from.conjugate() * Vector(t_to - t_from) - t_measured);
  Eigen::Quaternion<J> q_error = turn_back * (q_from.conjugate() * q_to);
  if (q_error.w().a < 0.0) q_error.coeffs() = -q_error.coeffs();
  Eigen::Matrix<J, 6, 1> error;
  error << t_error, J(2.0) * q_error.vec();
  return error;
}

class CostFunctionTest : public testing::TestWithParam<std::uint64_t> {
 protected:
  Rng rng_{GetParam()};
};

TEST_P(CostFunctionTest, WhitenedCostEqualsTheMahalanobisDistanceForANonDiagonalCovariance) {
  const Pose from = randomPose(rng_);
  const Pose to = randomPose(rng_);
  const Pose measured = randomPose(rng_);
  const Matrix6d cov = randomCovariance<6>(rng_);
  const RelativePose3Cost cost(measured, cov.inverse());
  double a[kPoseBlock];
  double b[kPoseBlock];
  writeBlock(from, a);
  writeBlock(to, b);
  const double* blocks[] = {a, b};
  Vector6d whitened;
  ASSERT_TRUE(cost.Evaluate(blocks, whitened.data(), nullptr));
  const Vector6d error = edgeError(from, to, measured);
  const double expected = error.dot(cov.inverse() * error);
  EXPECT_NEAR(whitened.squaredNorm(), expected, 1e-9 * expected);
  const Matrix6d lower = cov.inverse().llt().matrixL();
  EXPECT_GT(std::abs((lower * error).squaredNorm() - expected), 1e-3 * expected) << "the test could not tell L from U";
}

TEST_P(CostFunctionTest, SpatialErrorAndDerivativesEqualAutomaticOnes) {
  const Pose from = randomPose(rng_);
  const Pose to = randomPose(rng_);
  const Pose measured = randomPose(rng_);
  const Matrix6d information = randomCovariance<6>(rng_);
  const RelativePose3Cost cost(measured, information);
  double a[kPoseBlock];
  double b[kPoseBlock];
  writeBlock(from, a);
  writeBlock(to, b);
  const double* blocks[] = {a, b};
  Vector6d whitened;
  RowMajor<6, 7> by_from;
  RowMajor<6, 7> by_to;
  double* jacobians[] = {by_from.data(), by_to.data()};
  ASSERT_TRUE(cost.Evaluate(blocks, whitened.data(), jacobians));
  const auto automatic = automaticError(from, to, measured);
  Vector6d error;
  Eigen::Matrix<double, 6, 12> derivative;
  for (int i = 0; i < 6; ++i) {
    error[i] = automatic[i].a;
    derivative.row(i) = automatic[i].v.transpose();
  }
  const Matrix6d root = upperSquareRoot(information);
  EXPECT_TRUE(whitened.isApprox(root * error, 1e-10));
  EXPECT_TRUE((by_from.leftCols<6>().isApprox(root * derivative.leftCols<6>(), 1e-9)));
  EXPECT_TRUE((by_to.leftCols<6>().isApprox(root * derivative.rightCols<6>(), 1e-9)));
  EXPECT_TRUE(by_from.col(6).isZero());
}

TEST_P(CostFunctionTest, PlanarErrorAndDerivativesEqualAutomaticOnes) {
  using J = Jet<6>;
  const Pose2 from = randomPose2(rng_);
  const Pose2 to = randomPose2(rng_);
  const Pose2 measured = randomPose2(rng_);
  const J x[] = {J(from.translation_m.x(), 0), J(from.translation_m.y(), 1), J(from.heading_rad, 2)};
  const J y[] = {J(to.translation_m.x(), 3), J(to.translation_m.y(), 4), J(to.heading_rad, 5)};
  const J dx = y[0] - x[0];
  const J dy = y[1] - x[1];
  const J seen_x = cos(x[2]) * dx + sin(x[2]) * dy - measured.translation_m.x();
  const J seen_y = -sin(x[2]) * dx + cos(x[2]) * dy - measured.translation_m.y();
  const double c = std::cos(measured.heading_rad);
  const double s = std::sin(measured.heading_rad);
  const J heading = y[2] - x[2] - measured.heading_rad;
  const J errors[] = {c * seen_x + s * seen_y, -s * seen_x + c * seen_y, heading};
  double a[kPose2Block];
  double b[kPose2Block];
  writeBlock(from, a);
  writeBlock(to, b);
  const auto analytic = relativeError(a, b, measured);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(analytic.error[i], i == 2 ? wrappedAngle(errors[i].a) : errors[i].a, 1e-12);
    EXPECT_TRUE(analytic.by_from.row(i).transpose().isApprox(errors[i].v.head<3>(), 1e-12));
    EXPECT_TRUE(analytic.by_to.row(i).transpose().isApprox(errors[i].v.tail<3>(), 1e-12));
  }
}

TEST_P(CostFunctionTest, PointDerivativesEqualDifferenceQuotients) {
  const Pose pose = randomPose(rng_);
  const Eigen::Vector3d point = randomVector<3>(rng_, 5.0);
  const PointCost<3> cost(randomVector<3>(rng_, 5.0), randomCovariance<3>(rng_));
  double block[kPoseBlock];
  writeBlock(pose, block);
  const double* blocks[] = {block, point.data()};
  Eigen::Vector3d whitened;
  RowMajor<3, 7> by_pose;
  RowMajor<3, 3> by_point;
  double* jacobians[] = {by_pose.data(), by_point.data()};
  ASSERT_TRUE(cost.Evaluate(blocks, whitened.data(), jacobians));
  constexpr double kStep = 1e-6;
  for (int i = 0; i < 9; ++i) {
    Eigen::Vector3d ends[2];
    for (const int sign : {0, 1}) {
      Vector6d delta = Vector6d::Zero();
      Eigen::Vector3d moved = point;
      (i < 6 ? delta[i] : moved[i - 6]) += (sign == 1 ? kStep : -kStep);
      double moved_block[kPoseBlock];
      addToPose(block, delta.data(), moved_block);
      const double* moved_blocks[] = {moved_block, moved.data()};
      cost.Evaluate(moved_blocks, ends[sign].data(), nullptr);
    }
    const Eigen::Vector3d quotient = (ends[1] - ends[0]) / (2.0 * kStep);
    const Eigen::Vector3d analytic = i < 6 ? Eigen::Vector3d(by_pose.col(i)) : Eigen::Vector3d(by_point.col(i - 6));
    EXPECT_TRUE(analytic.isApprox(quotient, 1e-6)) << "coordinate " << i;
  }
}

TEST_P(CostFunctionTest, RotationErrorTakesTheShorterWayRound) {
  const Pose from = randomPose(rng_);
  Pose to = randomPose(rng_);
  const Pose measured = randomPose(rng_);
  const Vector6d error = edgeError(from, to, measured);
  to.rotation.coeffs() *= -1.0;
  EXPECT_TRUE(edgeError(from, to, measured).isApprox(error, 1e-12));
}

INSTANTIATE_TEST_SUITE_P(Seeds, CostFunctionTest, testing::Range<std::uint64_t>(1, 21));

}  // namespace
}  // namespace semantic_mht_slam
