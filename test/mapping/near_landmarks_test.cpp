#include "semantic_mht_slam/mapping/near_landmarks.h"

#include <cmath>

#include <gtest/gtest.h>

namespace semantic_mht_slam {
namespace {

Detection detectionAt(double x_m, double size_m = 0.0) {
  Detection detection;
  detection.position_m.x() = x_m;
  detection.cov_m2 = 0.01 * Eigen::Matrix3d::Identity();
  if (size_m > 0.0) detection.size_m = Eigen::Vector3d(size_m, 0.1, 0.1);
  return detection;
}

/// What is near in frames of these detections; their landmarks count from 1 in each frame.
std::vector<NearLandmarks> nearIn(const std::vector<Detections>& frames) {
  std::vector<Frame> with_odometry;
  std::vector<DetectionAssociation> associations;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    with_odometry.push_back({f, 0, Pose::identity(), frames[f]});
    LandmarkId landmark = 1;
    for (int row = 0; row < static_cast<int>(frames[f].size()); ++row) associations.push_back({f, row, landmark++});
  }
  return findNearLandmarks(with_odometry, associations, 9.0);
}

TEST(NearLandmarksTest, NearIsWhatTheNoiseOfBothCentroidsExplains) {
  const double limit_m = 3.0 * std::sqrt(0.02);
  EXPECT_EQ(nearIn({{detectionAt(0.0), detectionAt(0.99 * limit_m)}}).size(), 1U);
  EXPECT_TRUE(nearIn({{detectionAt(0.0), detectionAt(1.01 * limit_m)}}).empty());
}

TEST(NearLandmarksTest, PartsOfALargeObjectAreNear) {
  EXPECT_EQ(nearIn({{detectionAt(0.0, 4.0), detectionAt(3.5, 4.0)}}).size(), 1U);
  EXPECT_TRUE(nearIn({{detectionAt(0.0, 4.0), detectionAt(4.5, 4.0)}}).empty());
}

TEST(NearLandmarksTest, FramesAreCountedAndPairsComeInOrder) {
  const Detections three = {detectionAt(0.0), detectionAt(0.1), detectionAt(0.2)};
  const auto near = nearIn({three, {detectionAt(0.0), detectionAt(0.1)}, {detectionAt(0.0), detectionAt(5.0)}});
  ASSERT_EQ(near.size(), 3U);
  EXPECT_EQ(near[0].a, 1U);
  EXPECT_EQ(near[0].b, 2U);
  EXPECT_EQ(near[0].frames, 2);
  EXPECT_EQ(near[2].a, 2U);
  EXPECT_EQ(near[2].frames, 1);
}

TEST(NearLandmarksTest, AllDetectionsOfALandmarkMustBeNear) {
  const Frame frame{0, 0, Pose::identity(), {detectionAt(0.0), detectionAt(0.1), detectionAt(2.0)}};
  EXPECT_TRUE(findNearLandmarks({frame}, {{0, 0, 1}, {0, 1, 2}, {0, 2, 2}}, 9.0).empty()) << "2 is also 2 m away";
  EXPECT_EQ(findNearLandmarks({frame}, {{0, 0, 1}, {0, 1, 2}, {0, 2, kNoLandmark}}, 9.0).size(), 1U);
}

}  // namespace
}  // namespace semantic_mht_slam
