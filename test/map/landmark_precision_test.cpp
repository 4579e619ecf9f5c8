#include "semantic_mht_slam/map/landmark_precision.h"

#include <gtest/gtest.h>

namespace semantic_mht_slam {
namespace {

MixtureLandmark landmarkWith(const Eigen::Matrix3d& cov_m2) {
  MixtureLandmark landmark;
  landmark.position = {{1.0 / 3.0, 200.0 / 3.0, -1e-3 / 3.0}, cov_m2};
  landmark.components = {{1.0, landmark.position}};
  landmark.class_probs = ClassProbs::Constant(3, 1.0 / 3.0);
  landmark.existence_prob = 2.0 / 3.0;
  return landmark;
}

TEST(LandmarkPrecisionTest, SevenDigitsAreKept) {
  const Eigen::Matrix3d cov_m2 = Eigen::Vector3d(1.0 / 7.0, 3.0, 1e-4 / 3.0).asDiagonal();
  const MixtureLandmark landmark = landmarkWith(cov_m2);
  const MixtureLandmark rounded = withSevenDigits(landmark);
  EXPECT_TRUE(rounded.position.mean_m.isApprox(landmark.position.mean_m, 1e-7));
  EXPECT_TRUE(rounded.position.cov_m2.isApprox(cov_m2, 1e-7));
  EXPECT_NE(rounded.position.mean_m.x(), landmark.position.mean_m.x());
  EXPECT_NE(rounded.existence_prob, landmark.existence_prob);
  EXPECT_EQ(rounded.components.front().position.cov_m2, rounded.position.cov_m2);
  EXPECT_NEAR(rounded.class_probs.sum(), 1.0, 1e-6);
  EXPECT_EQ(withSevenDigits(rounded).position.mean_m, rounded.position.mean_m);
}

TEST(LandmarkPrecisionTest, ThinCovarianceStaysPositive) {
  Eigen::Matrix3d cov_m2 = Eigen::Matrix3d::Identity();
  cov_m2(0, 1) = cov_m2(1, 0) = 1.0 - 1e-12;
  const MixtureLandmark rounded = withSevenDigits(landmarkWith(cov_m2));
  EXPECT_EQ(rounded.position.cov_m2, cov_m2);
  EXPECT_EQ(rounded.components.front().position.cov_m2, cov_m2);
}

}  // namespace
}  // namespace semantic_mht_slam
