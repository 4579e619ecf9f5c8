#include "semantic_mht_slam/common/pose.h"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include "semantic_mht_slam/common/random.h"

namespace semantic_mht_slam {
namespace {

Pose randomPose(Rng& rng) {
  const Eigen::Vector3d axis_angle(rng.normal(), rng.normal(), rng.normal());
  return {expRotation(axis_angle), {rng.normal(0.0, 10.0), rng.normal(0.0, 10.0), rng.normal(0.0, 10.0)}};
}

double difference(const Pose& a, const Pose& b) {
  return (a.matrix() - b.matrix()).cwiseAbs().maxCoeff();
}

TEST(PoseTest, ComposesAndInvertsAsMatricesDo) {
  Rng rng(1);
  for (int i = 0; i < 100; ++i) {
    const Pose a = randomPose(rng);
    const Pose b = randomPose(rng);
    const Eigen::Vector3d point(rng.normal(), rng.normal(), rng.normal());
    const Eigen::Matrix4d product = (Eigen::Affine3d(a.matrix()) * Eigen::Affine3d(b.matrix())).matrix();
    EXPECT_LT((product.topRows<3>() - (a * b).matrix()).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_LT(((a * b) * point - a * (b * point)).norm(), 1e-12);
    EXPECT_LT(difference(a.inverse() * a, Pose::identity()), 1e-12);
    EXPECT_LT(difference(Pose::fromMatrix(a.matrix()), a), 1e-12);
  }
}

TEST(PoseTest, RotationLogarithmInvertsTheExponentialUpToPi) {
  Rng rng(2);
  for (const double angle : {0.0, 1e-14, 1e-9, 1e-4, 1.0, 3.0, M_PI - 1e-6}) {
    const Eigen::Vector3d axis = Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal()).normalized();
    const Eigen::Vector3d axis_angle = angle * axis;
    EXPECT_LT((logRotation(expRotation(axis_angle)) - axis_angle).norm(), 1e-9) << angle;
    const Eigen::Quaterniond q = expRotation(axis_angle);
    EXPECT_LT((logRotation(Eigen::Quaterniond(-q.coeffs())) - axis_angle).norm(), 1e-9) << "other sign, " << angle;
  }
}

TEST(PoseTest, InterpolationGoesAtConstantSpeedFromEndToEnd) {
  const Pose from{expRotation({0.0, 0.0, 0.1}), {1.0, 2.0, 3.0}};
  const Pose to{expRotation({0.0, 0.0, 0.5}), {5.0, 2.0, 1.0}};
  EXPECT_EQ(difference(interpolate(from, to, 0.0), from), 0.0);
  EXPECT_EQ(difference(interpolate(from, to, 1.0), to), 0.0);
  const Pose quarter = interpolate(from, to, 0.25);
  EXPECT_LT((quarter.translation_m - Eigen::Vector3d(2.0, 2.0, 2.5)).norm(), 1e-12);
  EXPECT_NEAR(angularDistance(from.rotation, quarter.rotation), 0.1, 1e-12);
  EXPECT_THROW(interpolate(from, to, 1.01), std::invalid_argument);
  EXPECT_THROW(interpolate(from, to, std::nan("")), std::invalid_argument);
}

TEST(PoseTest, InvalidPosesAreRecognised) {
  EXPECT_TRUE(Pose::identity().isValid());
  EXPECT_FALSE((Pose{{1.0, 0.0, 0.0, 0.0}, {0.0, std::nan(""), 0.0}}).isValid());
  EXPECT_FALSE((Pose{{0.0, 0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}}).isValid());
  EXPECT_FALSE((Pose{{1.1, 0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}}).isValid());
}

TEST(PoseTest, NormalisingTwiceChangesNoBit) {
  Rng rng(3);
  for (int i = 0; i < 100; ++i) {
    const Pose once = normalized({Eigen::Quaterniond(rng.normal(), rng.normal(), rng.normal(), rng.normal()), {}});
    EXPECT_EQ(normalized(once).rotation.coeffs(), once.rotation.coeffs());
    EXPECT_NEAR(once.rotation.norm(), 1.0, 1e-12);
  }
  EXPECT_THROW(normalized({{0.0, 0.0, 0.0, 0.0}, {}}), std::invalid_argument);
}

}  // namespace
}  // namespace semantic_mht_slam
