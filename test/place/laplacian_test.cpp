#include "semantic_mht_slam/place/laplacian.h"

#include <stdexcept>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "place/scenes.h"

namespace semantic_mht_slam {
namespace {

constexpr int kClasses = 6;

TEST(LaplacianTest, HoldsDegreesLessWeightsOfTwoClasses) {
  Rng rng(1);
  Scene scene = randomScene(3, kClasses, rng);
  scene.objects[0].class_index = 2;
  scene.objects[1].class_index = 2;
  scene.objects[2].class_index = 4;
  const CovisibilityConfig config;
  const auto weight = [&](int i, int j) {
    return distanceKernel((scene.objects[i].position_m - scene.objects[j].position_m).norm(), config);
  };
  const Eigen::MatrixXd laplacian = classLaplacian(scene, kClasses, config);
  const double between = weight(0, 2) + weight(1, 2);
  EXPECT_NEAR(laplacian(2, 4), -between, 1e-15);
  EXPECT_NEAR(laplacian(4, 4), between, 1e-15);
  EXPECT_NEAR(laplacian(2, 2), between + weight(0, 1), 1e-15);
  EXPECT_EQ(laplacian.row(0).cwiseAbs().sum(), 0.0);
}

TEST(LaplacianTest, IsSymmetricAndPositiveSemidefinite) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    Rng rng(seed);
    const Eigen::MatrixXd laplacian = classLaplacian(randomScene(25, kClasses, rng), kClasses, CovisibilityConfig{});
    EXPECT_TRUE(laplacian.isApprox(laplacian.transpose()));
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(laplacian, Eigen::EigenvaluesOnly);
    EXPECT_GE(solver.eigenvalues().minCoeff(), -1e-9) << "seed " << seed;
  }
}

TEST(LaplacianTest, DoesNotDependOnWhereTheSceneIsSeenFrom) {
  Rng rng(3);
  const Scene scene = randomScene(20, kClasses, rng);
  const Scene turned = seenFrom(scene, M_PI, {12.0, -3.0, 0.5}, 0.0, rng);
  EXPECT_TRUE(classLaplacian(scene, kClasses, CovisibilityConfig{})
                  .isApprox(classLaplacian(turned, kClasses, CovisibilityConfig{}), 1e-9));
}

TEST(LaplacianTest, UsesTheGraphForLandmarksThatItSawTogether) {
  Rng rng(4);
  const CovisibilityConfig config;
  const Scene scene = withLandmarks(randomScene(2, 1, rng), 1);
  CovisibilityGraph graph(config);
  EXPECT_EQ(classLaplacian(scene, 1, graph, config), classLaplacian(scene, 1, config));
  graph.addKeyframe(scene);
  Scene one_of_them = scene;
  one_of_them.objects.pop_back();
  graph.addKeyframe(one_of_them);
  EXPECT_TRUE(classLaplacian(scene, 1, graph, config).isApprox(0.5 * classLaplacian(scene, 1, config)));
}

TEST(LaplacianTest, ClassesOutsideTheTableThrow) {
  Rng rng(5);
  Scene scene = randomScene(2, kClasses, rng);
  scene.objects[0].class_index = kClasses;
  EXPECT_THROW(classLaplacian(scene, kClasses, CovisibilityConfig{}), std::invalid_argument);
}

TEST(LaplacianCorrelationTest, IsSymmetricBoundedAndOneForTheSameScene) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    Rng rng(seed);
    const auto a = classLaplacian(randomScene(2 + static_cast<int>(rng.index(30)), kClasses, rng), kClasses, {});
    const auto b = classLaplacian(randomScene(2 + static_cast<int>(rng.index(30)), kClasses, rng), kClasses, {});
    const double correlation = laplacianCorrelation(a, b);
    EXPECT_DOUBLE_EQ(correlation, laplacianCorrelation(b, a));
    EXPECT_LE(std::abs(correlation), 1.0);
    EXPECT_NEAR(laplacianCorrelation(a, a), laplacianCorrelation(a, 3.0 * a), 1e-12);
  }
  Rng rng(1);
  const auto a = classLaplacian(randomScene(20, kClasses, rng), kClasses, {});
  EXPECT_NEAR(laplacianCorrelation(a, a), 1.0, 1e-12);
  EXPECT_NEAR(laplacianCorrelation(a, -a), -1.0, 1e-12);
}

TEST(LaplacianCorrelationTest, DoesNotRiseWithClassesThatAreInNeitherScene) {
  Rng rng(2);
  const Scene a = randomScene(15, 3, rng);
  const Scene b = randomScene(15, 3, rng);
  EXPECT_NEAR(laplacianCorrelation(classLaplacian(a, 3, {}), classLaplacian(b, 3, {})),
              laplacianCorrelation(classLaplacian(a, 30, {}), classLaplacian(b, 30, {})), 1e-12);
}

TEST(LaplacianCorrelationTest, IsZeroWithoutVariance) {
  Rng rng(3);
  const auto some = classLaplacian(randomScene(15, kClasses, rng), kClasses, {});
  const Eigen::MatrixXd nothing = classLaplacian(Scene{}, kClasses, {});
  EXPECT_EQ(laplacianCorrelation(some, nothing), 0.0);
  EXPECT_EQ(laplacianCorrelation(nothing, nothing), 0.0);
  const auto one_class = classLaplacian(randomScene(15, 1, rng), kClasses, {});
  EXPECT_EQ(laplacianCorrelation(one_class, one_class), 0.0);
  EXPECT_EQ(laplacianCorrelation(Eigen::MatrixXd(0, 0), Eigen::MatrixXd(0, 0)), 0.0);
}

TEST(LaplacianCorrelationTest, DifferentSizesThrow) {
  EXPECT_THROW(laplacianCorrelation(Eigen::MatrixXd::Zero(2, 2), Eigen::MatrixXd::Zero(3, 3)), std::invalid_argument);
}

}  // namespace
}  // namespace semantic_mht_slam
