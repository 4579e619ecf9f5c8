#include "semantic_mht_slam/place/scene_alignment.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "scene_test_util.h"

namespace semantic_mht_slam {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;

const ClassTable kClasses = makeStreetClasses();

std::vector<SceneAlignment> align(const Scene& query, const Scene& match, const SceneAlignmentConfig& config) {
  return alignScenes(makePlanarScene(query, kClasses, config.noise_floor_m),
                     makePlanarScene(match, kClasses, config.noise_floor_m), kClasses, config);
}

/// Step on the right of `T_estimate` that leads to `T_truth`: translation, rotation.
Vector6 errorOf(const Pose& T_estimate, const Pose& T_truth) {
  const Pose step = T_estimate.inverse() * T_truth;
  Vector6 error;
  error << step.translation_m, logRotation(step.rotation);
  return error;
}

class SceneAlignmentSearchTest : public ::testing::TestWithParam<AlignmentSearch> {
 protected:
  SceneAlignmentSearchTest() { config_.search = GetParam(); }

  void expectFound(const Scene& query, const Scene& match, const Pose& T_match_query, int seed) const {
    const std::vector<SceneAlignment> found = align(query, match, config_);
    ASSERT_FALSE(found.empty()) << "seed " << seed;
    const Vector6 error = errorOf(found.front().T_match_query, T_match_query);
    EXPECT_LT(error.head<2>().norm(), 0.3) << "seed " << seed;
    EXPECT_LT(error.tail<3>().norm(), 0.04) << "seed " << seed;
  }

  SceneAlignmentConfig config_;
};

TEST_P(SceneAlignmentSearchTest, FindsTheMotionInTheOppositeDirectionOfTravel) {
  for (int seed = 0; seed < 20; ++seed) {
    Rng rng(seed);
    const Scene match = makeStreet(30, 0.05, rng);
    const Pose T_match_query = planarPose(rng.uniform(-4.0, 4.0), rng.uniform(-4.0, 4.0), M_PI + rng.normal(0.0, 0.1));
    expectFound(seenFrom(match, T_match_query, rng), match, T_match_query, seed);
  }
}

TEST_P(SceneAlignmentSearchTest, SurvivesPartialOverlapAndCarsThatLeft) {
  for (int seed = 0; seed < 20; ++seed) {
    Rng rng(100 + seed);
    const Scene world = makeStreet(60, 0.05, rng);
    const Pose T_match_query = planarPose(rng.uniform(-5.0, 5.0), rng.uniform(-3.0, 3.0), rng.uniform(-M_PI, M_PI));
    Scene query = seenFrom(world, T_match_query, rng);
    Scene match = world;
    const auto left = [&](const SceneObject& object) { return object.class_index == 2 && rng.bernoulli(0.6); };
    query.objects.erase(std::remove_if(query.objects.begin(), query.objects.end(), left), query.objects.end());
    const auto beyond = [](const SceneObject& object) { return object.position_m.x() > 15.0; };
    match.objects.erase(std::remove_if(match.objects.begin(), match.objects.end(), beyond), match.objects.end());
    expectFound(query, match, T_match_query, seed);
  }
}

INSTANTIATE_TEST_SUITE_P(Searches, SceneAlignmentSearchTest,
                         ::testing::Values(AlignmentSearch::kVotes, AlignmentSearch::kClique,
                                           AlignmentSearch::kRansac));

TEST(SceneAlignmentTest, SurvivesFourWrongObjectsForEachRightOne) {
  for (int seed = 0; seed < 20; ++seed) {
    Rng rng(200 + seed);
    const Scene common = makeStreet(12, 0.03, rng);
    const Pose T_match_query = planarPose(rng.uniform(-4.0, 4.0), rng.uniform(-4.0, 4.0), rng.uniform(-M_PI, M_PI));
    Scene query = seenFrom(common, T_match_query, rng);
    Scene match = common;
    for (const SceneObject& object : makeStreet(48, 0.03, rng).objects) query.objects.push_back(object);
    for (const SceneObject& object : makeStreet(48, 0.03, rng).objects) match.objects.push_back(object);
    const std::vector<SceneAlignment> found = align(query, match, {});
    ASSERT_FALSE(found.empty());
    EXPECT_LT(errorOf(found.front().T_match_query, T_match_query).head<2>().norm(), 0.4) << "seed " << seed;
  }
}

/// Mean of the normalised squared error over seeds, which is 6 when the covariance is right.
double meanNees(bool mapped) {
  SceneAlignmentConfig config;
  config.noise_floor_m = 0.001;
  config.height_stddev_m = 0.001;
  double sum = 0.0;
  constexpr int kSeeds = 100;
  for (int seed = 0; seed < kSeeds; ++seed) {
    Rng rng(1000 + seed);
    Scene match = makeStreet(25, 0.2, rng);
    const Pose T_match_query = planarPose(rng.normal(), rng.normal(), rng.uniform(-M_PI, M_PI));
    Scene truth = match;
    for (SceneObject& object : truth.objects) object.cov_m2 *= 1e-12;
    Scene query = seenFrom(truth, T_match_query, rng);
    Eigen::Vector3d common_m(rng.normal(), rng.normal(), rng.normal());
    for (SceneObject& object : match.objects) {
      const Eigen::Vector3d own_m(rng.normal(), rng.normal(), rng.normal());
      object.position_m += 0.2 * (mapped ? common_m : own_m);
      if (mapped) object.landmark = 1;
    }
    for (SceneObject& object : query.objects) {
      object.cov_m2 = Eigen::Matrix3d::Identity() * 0.04;
      for (int axis = 0; axis < 3; ++axis) object.position_m(axis) += rng.normal(0.0, 0.2);
    }
    const std::vector<SceneAlignment> found = align(query, match, config);
    if (found.empty()) return 1e9;
    const Vector6 error = errorOf(found.front().T_match_query, T_match_query);
    sum += error.dot(found.front().cov.ldlt().solve(error));
  }
  return sum / kSeeds;
}

TEST(SceneAlignmentTest, CovarianceIsConsistentForIndependentErrorsOfDetections) {
  const double nees = meanNees(false);  // roll and pitch are better than their prior says, hence the lower bound
  EXPECT_LT(nees, 7.2);
  EXPECT_GT(nees, 3.0);
}

TEST(SceneAlignmentTest, CovarianceIsConsistentForAnErrorThatMappedLandmarksShare) {
  const double nees = meanNees(true);
  EXPECT_LT(nees, 7.2);
  EXPECT_GT(nees, 2.5);
}

TEST(SceneAlignmentTest, IsNeverMoreCertainThanTheLandmarks) {
  Rng rng(5);
  Scene match = makeStreet(60, 0.3, rng);
  for (SceneObject& object : match.objects) object.landmark = 1;
  const Scene query = seenFrom(match, planarPose(1.0, 2.0, 0.3), rng);
  const std::vector<SceneAlignment> found = align(query, match, {});
  ASSERT_FALSE(found.empty());
  const Eigen::Matrix3d excess = found.front().cov.topLeftCorner<3, 3>() - 0.09 * Eigen::Matrix3d::Identity();
  EXPECT_TRUE((Eigen::Vector3d(excess.selfadjointView<Eigen::Lower>().eigenvalues()).array() > -1e-9).all());
}

TEST(SceneAlignmentTest, OrderOfObjectsChangesNothing) {
  Rng rng(6);
  const Scene match = makeStreet(30, 0.05, rng);
  const Scene query = seenFrom(match, planarPose(1.0, 2.0, 2.0), rng);
  Scene reversed = query;
  std::reverse(reversed.objects.begin(), reversed.objects.end());
  const std::vector<SceneAlignment> a = align(query, match, {});
  const std::vector<SceneAlignment> b = align(reversed, match, {});
  ASSERT_EQ(a.size(), b.size());
  ASSERT_FALSE(a.empty());
  EXPECT_EQ(a.front().T_match_query.translation_m, b.front().T_match_query.translation_m);
  EXPECT_EQ(a.front().similarity, b.front().similarity);
  EXPECT_EQ(a.front().cov, b.front().cov);
}

TEST(SceneAlignmentTest, EmptyScenesAndSingleObjectsHaveNoAlignment) {
  Rng rng(7);
  const Scene street = makeStreet(20, 0.05, rng);
  Scene one;
  one.objects.push_back(street.objects.front());
  EXPECT_TRUE(align({}, street, {}).empty());
  EXPECT_TRUE(align(street, {}, {}).empty());
  EXPECT_TRUE(align(one, street, {}).empty());
}

TEST(SceneAlignmentTest, BadObjectsAreRefused) {
  Rng rng(8);
  Scene scene = makeStreet(3, 0.05, rng);
  scene.objects[1].class_index = 3;
  EXPECT_THROW(makePlanarScene(scene, kClasses, 0.1), std::invalid_argument);
  scene.objects[1].class_index = 0;
  scene.objects[1].position_m.x() = NAN;
  EXPECT_THROW(makePlanarScene(scene, kClasses, 0.1), std::invalid_argument);
  scene.objects[1].position_m.x() = 0.0;
  scene.objects[1].cov_m2.setZero();
  EXPECT_THROW(makePlanarScene(scene, kClasses, 0.1), std::invalid_argument);
}

}  // namespace
}  // namespace semantic_mht_slam
