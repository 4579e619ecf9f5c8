#include "semantic_mht_slam/evaluation/rigid_alignment.h"

#include <cmath>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

namespace semantic_mht_slam {
namespace {

using Points = std::vector<Eigen::Vector3d>;

Points randomPoints(std::mt19937& engine, int count) {
  std::normal_distribution<double> normal(0.0, 10.0);
  Points points;
  for (int i = 0; i < count; ++i) {
    const double x = normal(engine);
    const double y = normal(engine);
    points.emplace_back(x, y, normal(engine));
  }
  return points;
}

Points transformed(const Pose& T_target_source, const Points& source) {
  Points target;
  for (const Eigen::Vector3d& point : source) target.push_back(T_target_source * point);
  return target;
}

double cost(const Pose& T_target_source, const Points& source, const Points& target) {
  double sum = 0.0;
  for (std::size_t i = 0; i < source.size(); ++i) sum += (T_target_source * source[i] - target[i]).squaredNorm();
  return sum;
}

class RigidAlignmentTest : public ::testing::TestWithParam<unsigned> {
 protected:
  std::mt19937 engine_{GetParam()};
};

TEST_P(RigidAlignmentTest, RecoversATransform) {
  const Points vectors = randomPoints(engine_, 2);
  const Pose T_target_source{expRotation(vectors[0].normalized() * 2.5), vectors[1]};
  const Points source = randomPoints(engine_, 20);
  const Pose found = rigidAlignment(source, transformed(T_target_source, source));
  EXPECT_LT(angularDistance(found.rotation, T_target_source.rotation), 1e-9);
  EXPECT_LT((found.translation_m - T_target_source.translation_m).norm(), 1e-9);
}

TEST_P(RigidAlignmentTest, NoNeighbouringTransformFitsNoisyPointsBetter) {
  const Points source = randomPoints(engine_, 15);
  Points target = randomPoints(engine_, 15);  // as noise of the same size as the points
  for (std::size_t i = 0; i < target.size(); ++i) target[i] += source[i];
  const Pose best = rigidAlignment(source, target);
  const double least = cost(best, source, target);
  for (const Eigen::Vector3d& direction : randomPoints(engine_, 20)) {
    const Eigen::Vector3d small = 1e-3 * direction.normalized();
    EXPECT_GT(cost({(expRotation(small) * best.rotation).normalized(), best.translation_m}, source, target), least);
    EXPECT_GT(cost({best.rotation, best.translation_m + small}, source, target), least);
  }
}

TEST_P(RigidAlignmentTest, StaysARotationForMirroredPoints) {
  const Points source = randomPoints(engine_, 12);
  Points target = source;
  for (Eigen::Vector3d& point : target) point.x() = -point.x();
  EXPECT_TRUE(rigidAlignment(source, target).isValid());
  EXPECT_NEAR(rigidAlignment(source, target).matrix().leftCols<3>().determinant(), 1.0, 1e-9);
}

TEST_P(RigidAlignmentTest, PlanarAlignmentRecoversYawAndShift) {
  const Points source = randomPoints(engine_, 10);
  const Pose T_target_source{expRotation({0.0, 0.0, -2.0}), {3.0, -4.0, 0.5}};
  const Pose found = planarAlignment(source, transformed(T_target_source, source));
  EXPECT_LT(angularDistance(found.rotation, T_target_source.rotation), 1e-9);
  EXPECT_LT((found.translation_m - T_target_source.translation_m).norm(), 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Seeds, RigidAlignmentTest, ::testing::Range(0U, 10U));

TEST(RigidAlignmentTest, FitsPointsThatLeaveTheRotationOpen) {
  const Points line = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {2.0, 0.0, 0.0}};
  const Points turned = {{5.0, 0.0, 0.0}, {5.0, 1.0, 0.0}, {5.0, 2.0, 0.0}};
  EXPECT_NEAR(cost(rigidAlignment(line, turned), line, turned), 0.0, 1e-20);
  EXPECT_NEAR((rigidAlignment({{1.0, 2.0, 3.0}}, {{4.0, 4.0, 4.0}}) * Eigen::Vector3d(1.0, 2.0, 3.0)).x(), 4.0, 1e-12);
}

TEST(RigidAlignmentTest, PlanarAlignmentKeepsZUpright) {
  const Points source = {{0.0, 0.0, 0.0}, {10.0, 0.0, 0.0}, {0.0, 10.0, 0.0}};
  const Points tilted = transformed({expRotation({0.3, 0.0, 0.0}), Eigen::Vector3d::Zero()}, source);
  const Pose found = planarAlignment(source, tilted);
  EXPECT_NEAR((found.rotation * Eigen::Vector3d::UnitZ()).z(), 1.0, 1e-12);
  EXPECT_GT(cost(found, source, tilted), 1.0);
}

TEST(RigidAlignmentTest, RefusesListsThatDoNotBelongTogether) {
  EXPECT_THROW(rigidAlignment({}, {}), std::invalid_argument);
  EXPECT_THROW(rigidAlignment({{0.0, 0.0, 0.0}}, {}), std::invalid_argument);
  EXPECT_THROW(planarAlignment({{0.0, 0.0, 0.0}}, {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}}), std::invalid_argument);
  EXPECT_THROW(rigidAlignment({{std::nan(""), 0.0, 0.0}}, {{0.0, 0.0, 0.0}}), std::invalid_argument);
}

}  // namespace
}  // namespace semantic_mht_slam
