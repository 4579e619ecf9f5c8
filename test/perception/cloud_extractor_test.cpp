#include "semantic_mht_slam/perception/cloud_extractor.h"

#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

#include "semantic_mht_slam/common/gaussian.h"
#include "semantic_mht_slam/common/pose.h"

#include "support/extraction_classes.h"
#include "support/scans.h"

namespace semantic_mht_slam {
namespace {

const ClassTable kClasses = makeExtractionClasses();
const LabelMap kLabels = makeExtractionLabels();
const ExtractionConfig kConfig{kClasses};

/// Two poles, two cars, a wall, road everywhere.
LabelledCloud makeStreet(Rng& rng) {
  LabelledCloud cloud;
  addBox(cloud, {10.0, 5.0, 0.0}, {0.2, 0.2, 3.0}, 60, kPoleLabel, rng);
  addBox(cloud, {20.0, -5.0, 0.0}, {0.2, 0.2, 3.0}, 40, kPoleLabel, rng);
  addBox(cloud, {8.0, -4.0, -1.0}, {4.0, 1.8, 1.5}, 900, kCarLabel, rng);
  addBox(cloud, {15.0, -4.0, -1.0}, {4.0, 1.8, 1.5}, 900, kMovingCarLabel, rng);
  addBox(cloud, {20.0, 12.0, 1.0}, {20.0, 0.3, 6.0}, 4000, kWallLabel, rng);
  addBox(cloud, {15.0, 0.0, -1.7}, {40.0, 10.0, 0.05}, 3000, kRoadLabel, rng);
  return cloud;
}

TEST(CloudExtractorTest, EachThingIsOneObjectOfItsClassWithMeanBoxAndCountOfItsPoints) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Rng rng(seed);
    const Extraction extraction = extractObjects(makeStreet(rng), kLabels, kConfig);
    ASSERT_EQ(extraction.objects.size(), 5U) << "seed " << seed;
    const std::vector<ClassIndex> classes = {kPole, kPole, kCar, kCar, kWall};
    const std::vector<int> points = {60, 40, 900, 900, 4000};
    const std::vector<Eigen::Vector3d> centers = {{10, 5, 0}, {20, -5, 0}, {8, -4, -1}, {15, -4, -1}, {20, 12, 1}};
    for (std::size_t i = 0; i < classes.size(); ++i) {
      const ExtractedObject& object = extraction.objects[i];
      EXPECT_EQ(object.detection.class_index, classes[i]);
      EXPECT_EQ(object.detection.points, points[i]);
      EXPECT_EQ(object.detection.row, static_cast<int>(i));
      EXPECT_EQ(*object.detection.size_m, object.box_max_m - object.box_min_m);
      EXPECT_TRUE(isCovariance(*object.detection.cov_m2));
      const auto error = evaluate({centers[i], *object.detection.cov_m2}, object.detection.position_m);
      EXPECT_LT(error->mahalanobis_sq, 9.0) << "seed " << seed << " object " << i;
    }
    EXPECT_FALSE(extraction.objects[2].detection.is_moving);
    EXPECT_TRUE(extraction.objects[3].detection.is_moving);
  }
}

TEST(CloudExtractorTest, MovingTheSensorMovesCentroidsAndTurnsCovariancesAlong) {
  Rng rng(3);
  LabelledCloud cloud = makeStreet(rng);
  const Extraction before = extractObjects(cloud, kLabels, kConfig);
  const Pose motion{expRotation({0.0, 0.0, 0.7}), {3.0, -2.0, 0.2}};
  for (Eigen::Vector3f& point : cloud.points_m) point = (motion * point.cast<double>()).cast<float>();
  const Extraction after = extractObjects(cloud, kLabels, kConfig);
  ASSERT_EQ(after.objects.size(), before.objects.size());
  for (std::size_t i = 0; i < before.objects.size(); ++i) {
    const Detection& a = before.objects[i].detection;
    const Detection& b = after.objects[i].detection;
    EXPECT_LT((motion * a.position_m - b.position_m).norm(), 1e-4);
    const Eigen::Matrix3d R = motion.rotation.toRotationMatrix();
    EXPECT_LT((R * *a.cov_m2 * R.transpose() - *b.cov_m2).norm(), 1e-3);
  }
}

TEST(CloudExtractorTest, SizeRuleRemovesClustersWithFewPointsAndLowOnes) {
  Rng rng(1);
  const ClusterConfig& rule = kConfig.classes[kPole];
  LabelledCloud cloud;
  addBox(cloud, {10.0, 0.0, 0.0}, {0.2, 0.2, 1.5}, rule.min_points - 1, kPoleLabel, rng);
  addBox(cloud, {10.0, 5.0, 0.0}, {0.2, 0.2, 0.5 * rule.min_height_m}, 100, kPoleLabel, rng);
  addBox(cloud, {10.0, -5.0, 0.0}, {0.2, 0.2, 1.5}, rule.min_points, kPoleLabel, rng);
  const Extraction extraction = extractObjects(cloud, kLabels, kConfig);
  ASSERT_EQ(extraction.objects.size(), 1U);
  EXPECT_NEAR(extraction.objects[0].detection.position_m.y(), -5.0, 0.2);
  EXPECT_EQ(extraction.objects[0].detection.score, 0.5);
  EXPECT_EQ(extraction.small_clusters, 2U);
}

TEST(CloudExtractorTest, UnusablePointsAndUnknownLabelsAreCountedAndChangeNothingElse) {
  Rng rng(2);
  LabelledCloud cloud = makeStreet(rng);
  const Extraction clean = extractObjects(cloud, kLabels, kConfig);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  for (const Eigen::Vector3f& point :
       {Eigen::Vector3f(nan, 1.0F, 1.0F), {1.0F, infinity, 1.0F}, {1e30F, 1e30F, 0.0F}}) {
    cloud.points_m.push_back(point);
    cloud.labels.push_back(kPoleLabel);
  }
  addBox(cloud, {0.0, 0.0, 0.0}, {0.5, 0.5, 0.5}, 50, kCarLabel, rng);
  addBox(cloud, {10.0, 8.0, 0.0}, {0.2, 0.2, 3.0}, 70, kUnknownLabel, rng);
  const Extraction extraction = extractObjects(cloud, kLabels, kConfig);
  ASSERT_EQ(extraction.objects.size(), clean.objects.size());
  for (std::size_t i = 0; i < clean.objects.size(); ++i) {
    EXPECT_EQ(extraction.objects[i].detection.position_m, clean.objects[i].detection.position_m);
  }
  EXPECT_EQ(extraction.points_not_finite, 2U);
  EXPECT_EQ(extraction.points_out_of_range, 51U) << "the far point and the car itself";
  EXPECT_EQ(extraction.unknown_labels, (std::map<std::uint16_t, std::size_t>{{kUnknownLabel, 70U}}));
  EXPECT_EQ(extraction.describeUnknownLabels("points"), "label ids that are not in the class map: 77 (70 points)");
}

TEST(CloudExtractorTest, EmptyCloudGivesNothingAndLabelsOfAnotherCountThrow) {
  EXPECT_TRUE(extractObjects(LabelledCloud{}, kLabels, kConfig).objects.empty());
  Rng rng(1);
  LabelledCloud cloud = makeStreet(rng);
  cloud.labels.pop_back();
  EXPECT_THROW(extractObjects(cloud, kLabels, kConfig), std::invalid_argument);
}

}  // namespace
}  // namespace semantic_mht_slam
