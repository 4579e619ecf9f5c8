#include "semantic_mht_slam/slam/keyframes.h"

#include <gtest/gtest.h>

namespace semantic_mht_slam {
namespace {

constexpr double kNoise_m2 = 0.01;

MixtureLandmark makeLandmark(LandmarkId id, const Eigen::Vector3d& position_m, double existence) {
  MixtureLandmark landmark;
  landmark.id = id;
  landmark.position = {position_m, 0.04 * Eigen::Matrix3d::Identity()};
  landmark.class_probs = ClassProbs::Constant(1, 1.0);
  landmark.existence_prob = existence;
  return landmark;
}

/// Ten frames 1 m apart that all see a pole at (20, 3, 1) and clutter; ids 1 and 2.
struct Drive {
  Drive() {
    submap.landmarks = {makeLandmark(1, {20.0, 3.0, 1.0}, 0.9), makeLandmark(2, {5.0, 5.0, 0.0}, 0.1)};
    for (int i = 0; i < 10; ++i) {
      Frame frame;
      frame.index = static_cast<std::size_t>(100 + i);
      frame.stamp = i;
      frame.T_odom_base.translation_m = {1.0 * i, 0.0, 0.0};
      for (int row = 0; row < 2; ++row) {
        Detection detection;
        detection.row = row;
        detection.cov_m2 = kNoise_m2 * Eigen::Matrix3d::Identity();
        detection.position_m = submap.landmarks[static_cast<std::size_t>(row)].position.mean_m -
                               frame.T_odom_base.translation_m + Eigen::Vector3d(0.0, i % 2 == 0 ? 0.1 : -0.1, 0.0);
        frame.detections.push_back(detection);
        submap.associations.push_back({frame.index, row, static_cast<LandmarkId>(row + 1)});
      }
      frames.push_back(frame);
    }
    config.spacing_m = 4.0;
  }

  Submap submap;
  std::vector<Frame> frames;
  KeyframeConfig config;
};

TEST(KeyframesTest, ASubmapIsCutByTheDistanceDriven) {
  const Drive drive;
  const auto [keyframes, sightings] =
      cutIntoKeyframes(drive.submap, drive.frames, {50.0, 0.0}, 0.5, OdometryModel{}, drive.config);
  ASSERT_EQ(keyframes.size(), 3U);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(keyframes[k].frame, 100 + 4 * k);
    EXPECT_DOUBLE_EQ(keyframes[k].driven_m, 50.0 + 4.0 * static_cast<double>(k));
  }
}

TEST(KeyframesTest, ASightingIsTheMeanOfItsDetectionsInTheKeyframe) {
  const Drive drive;
  const auto [keyframes, sightings] =
      cutIntoKeyframes(drive.submap, drive.frames, {}, 0.5, OdometryModel{}, drive.config);
  ASSERT_EQ(sightings[1].size(), 1U) << "what hardly exists is not a landmark";
  const Sighting& sighting = sightings[1][0];
  EXPECT_EQ(sighting.landmark, 1U);
  EXPECT_EQ(sighting.detections, 4);
  EXPECT_LT((sighting.position_m - Eigen::Vector3d(16.0, 3.0, 1.0)).norm(), 0.03);
  const double floor_m2 = drive.config.sighting_floor_m * drive.config.sighting_floor_m;
  EXPECT_GT(sighting.cov_m2(0, 0), floor_m2 + kNoise_m2 / 4.0 - 1e-12) << "odometry noise comes on top";
  EXPECT_LT(sighting.cov_m2(0, 0), floor_m2 + kNoise_m2);
  EXPECT_GT(sighting.cov_m2(2, 2), sighting.cov_m2(0, 0)) << "heights are known worse";
}

TEST(KeyframesTest, TheSceneHoldsTheFusedPositions) {
  const Drive drive;
  const auto [keyframes, sightings] =
      cutIntoKeyframes(drive.submap, drive.frames, {}, 0.5, OdometryModel{}, drive.config);
  ASSERT_EQ(keyframes[2].scene.objects.size(), 1U);
  EXPECT_LT((keyframes[2].scene.objects[0].position_m - Eigen::Vector3d(12.0, 3.0, 1.0)).norm(), 1e-12);
  EXPECT_EQ(keyframes[2].scene.objects[0].landmark, 1U);
}

TEST(KeyframesTest, KeyframesBelongToTheirSubmapAndEachHasItsSightings) {
  Drive drive;
  drive.submap.id = SubmapId(7);
  const auto [keyframes, sightings] =
      cutIntoKeyframes(drive.submap, drive.frames, {}, 0.05, OdometryModel{}, drive.config);
  ASSERT_EQ(sightings.size(), keyframes.size());
  for (const Keyframe& keyframe : keyframes) EXPECT_EQ(keyframe.submap, SubmapId(7));
  EXPECT_EQ(sightings[0].size(), 2U) << "both exist by this measure";
}

}  // namespace
}  // namespace semantic_mht_slam
