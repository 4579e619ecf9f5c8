#include "semantic_mht_slam/common/gaussian.h"

#include <cmath>

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace semantic_mht_slam {
namespace {

Eigen::Matrix3d makeCovariance() {
  Eigen::Matrix3d cov;
  cov << 2.0, 0.5, -0.3, 0.5, 1.0, 0.2, -0.3, 0.2, 0.7;
  return cov;
}

TEST(GaussianTest, DensityEqualsTheDefinition) {
  const Gaussian3 gaussian{{1.0, -2.0, 0.5}, makeCovariance()};
  const Eigen::Vector3d point(2.0, 0.0, 0.0);
  const Eigen::Vector3d d = point - gaussian.mean_m;
  const double squared = d.dot(gaussian.cov_m2.inverse() * d);
  const double density = std::exp(-0.5 * squared) / std::sqrt(std::pow(2.0 * M_PI, 3) * gaussian.cov_m2.determinant());
  const auto evaluation = evaluate(gaussian, point);
  ASSERT_TRUE(evaluation);
  EXPECT_NEAR(evaluation->mahalanobis_sq, squared, 1e-12);
  EXPECT_NEAR(evaluation->log_density, std::log(density), 1e-12);
}

TEST(GaussianTest, WhatIsNoCovarianceIsRefused) {
  EXPECT_TRUE(isCovariance(makeCovariance()));
  Eigen::Matrix3d asymmetric = makeCovariance();
  asymmetric(0, 1) += 0.1;
  EXPECT_FALSE(isCovariance(asymmetric));
  EXPECT_FALSE(isCovariance(Eigen::Vector3d(1.0, 0.0, 1.0).asDiagonal().toDenseMatrix()));
  EXPECT_FALSE(isCovariance(Eigen::Vector3d(1.0, -1.0, 1.0).asDiagonal().toDenseMatrix()));
  EXPECT_FALSE(isCovariance(Eigen::Matrix3d::Constant(std::nan(""))));
  EXPECT_FALSE(evaluate({Eigen::Vector3d::Zero(), Eigen::Matrix3d::Zero()}, Eigen::Vector3d::Zero()));
}

}  // namespace
}  // namespace semantic_mht_slam
