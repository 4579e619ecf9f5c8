#include "semantic_mht_slam/place/class_histogram.h"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include "place/random_histograms.h"

namespace semantic_mht_slam {
namespace {

ClassHistogram makeHistogram(std::initializer_list<double> shares) {
  ClassHistogram histogram(static_cast<Eigen::Index>(shares.size()));
  Eigen::Index i = 0;
  for (const double share : shares) histogram[i++] = share;
  return histogram;
}

Scene sceneOf(const std::vector<ClassIndex>& classes) {
  Scene scene;
  for (const ClassIndex class_index : classes) {
    SceneObject object;
    object.class_index = class_index;
    scene.objects.push_back(object);
  }
  return scene;
}

TEST(ClassHistogramTest, HoldsTheShareOfEachClassOfAScene) {
  const ClassHistogram histogram = classHistogram(sceneOf({2, 0, 2, 2}), 4);
  EXPECT_TRUE(histogram.isApprox(makeHistogram({0.25, 0.0, 0.75, 0.0})));
}

TEST(ClassHistogramTest, CountsALandmarkInItsMostLikelyClass) {
  std::vector<MixtureLandmark> landmarks(2);
  landmarks[0].class_probs = makeHistogram({0.6, 0.4, 0.0});
  landmarks[1].class_probs = makeHistogram({0.1, 0.2, 0.7});
  EXPECT_TRUE(classHistogram(landmarks, 3).isApprox(makeHistogram({0.5, 0.0, 0.5})));
}

TEST(ClassHistogramTest, ClassesOutsideTheTableThrow) {
  EXPECT_THROW(classHistogram(sceneOf({3}), 3), std::invalid_argument);
  EXPECT_THROW(classHistogram(sceneOf({-1}), 3), std::invalid_argument);
  EXPECT_THROW(classHistogram(sceneOf({0}), kMaxClasses + 1), std::invalid_argument);
}

TEST(ClassHistogramTest, OfNothingIsEmptyAndLikeNothing) {
  const ClassHistogram nothing = classHistogram(Scene{}, 3);
  EXPECT_TRUE(isEmpty(nothing));
  EXPECT_DOUBLE_EQ(jensenShannonDivergence(nothing, nothing), kMaxDivergence);
  EXPECT_DOUBLE_EQ(jensenShannonDivergence(nothing, makeHistogram({1.0, 0.0, 0.0})), kMaxDivergence);
  EXPECT_DOUBLE_EQ(euclideanDistance(nothing, nothing), std::sqrt(2.0));
}

TEST(ClassHistogramTest, DivergenceOfDisjointHistogramsIsLnTwo) {
  EXPECT_NEAR(jensenShannonDivergence(makeHistogram({1.0, 0.0}), makeHistogram({0.0, 1.0})), std::log(2.0), 1e-15);
}

TEST(ClassHistogramTest, DivergenceEqualsTheEntropyFormula) {
  // H(m) - (H(a) + H(b)) / 2 worked out for a = (1/2, 1/2), b = (1/4, 3/4).
  const auto entropy = [](double p) { return -p * std::log(p) - (1.0 - p) * std::log(1.0 - p); };
  const double expected = entropy(0.375) - 0.5 * (entropy(0.5) + entropy(0.25));
  EXPECT_NEAR(jensenShannonDivergence(makeHistogram({0.5, 0.5}), makeHistogram({0.25, 0.75})), expected, 1e-15);
}

TEST(ClassHistogramTest, DivergenceIsSymmetricBoundedAndZeroOnlyForEqualHistograms) {
  for (std::uint64_t seed = 1; seed <= 500; ++seed) {
    Rng rng(seed);
    const ClassHistogram a = randomHistogram(6, 1 + static_cast<int>(rng.index(20)), rng);
    const ClassHistogram b = randomHistogram(6, 1 + static_cast<int>(rng.index(20)), rng);
    const double divergence = jensenShannonDivergence(a, b);
    EXPECT_DOUBLE_EQ(divergence, jensenShannonDivergence(b, a));
    EXPECT_EQ(jensenShannonDivergence(a, a), 0.0);
    EXPECT_LE(divergence, kMaxDivergence);
    EXPECT_EQ(divergence == 0.0, (a == b).all()) << "seed " << seed;
  }
}

TEST(ClassHistogramTest, DivergenceTermRisesWithTheDistanceOfTheShares) {
  for (std::uint64_t seed = 1; seed <= 1000; ++seed) {
    Rng rng(seed);
    const double a = rng.uniform();
    const double near = rng.uniform();
    const double far = near < a ? near * rng.uniform() : near + (1.0 - near) * rng.uniform();
    EXPECT_LE(divergenceTerm(a, near), divergenceTerm(a, far) + 1e-15) << "seed " << seed;
  }
}

TEST(ClassHistogramTest, HistogramsOfDifferentTablesThrow) {
  EXPECT_THROW(jensenShannonDivergence(makeHistogram({1.0}), makeHistogram({1.0, 0.0})), std::invalid_argument);
  EXPECT_THROW(euclideanDistance(makeHistogram({1.0}), makeHistogram({1.0, 0.0})), std::invalid_argument);
}

}  // namespace
}  // namespace semantic_mht_slam
