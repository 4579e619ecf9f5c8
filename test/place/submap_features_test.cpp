#include "semantic_mht_slam/place/submap_features.h"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include "place/submaps.h"

namespace semantic_mht_slam {
namespace {

TEST(SubmapFeaturesTest, EntropyOfOneLandmarkIsThatOfItsGaussian) {
  MixtureLandmark landmark = makeLandmark({3.0, 4.0, 5.0}, 0, 1);
  landmark.position.cov_m2 = Eigen::Vector3d(1.0, 4.0, 9.0).asDiagonal();
  const double expected = 0.5 * std::log(std::pow(2.0 * M_PI * M_E, 3) * 36.0);
  EXPECT_NEAR(mixtureEntropy({landmark}).value(), expected, 1e-12);
}

TEST(SubmapFeaturesTest, EntropyCountsTheSpreadOfTheLandmarks) {
  const MixtureLandmark left = makeLandmark({-2.0, 0.0, 0.0}, 0, 1);
  const MixtureLandmark right = makeLandmark({2.0, 0.0, 0.0}, 0, 1);
  const double expected = 0.5 * std::log(std::pow(2.0 * M_PI * M_E, 3) * (4.01 * 0.01 * 0.01));
  EXPECT_NEAR(mixtureEntropy({left, right}).value(), expected, 1e-12);
}

TEST(SubmapFeaturesTest, EntropyOfNothingIsUndefined) {
  EXPECT_FALSE(mixtureEntropy({}).has_value());
  EXPECT_FALSE(mixtureEntropy({makeLandmark({0.0, 0.0, 0.0}, 0, 1, 0.0)}).has_value());
}

TEST(SubmapFeaturesTest, TfIdfEqualsTheFormulaByHand) {
  SubmapFeatureExtractor extractor(3);
  EXPECT_EQ(extractor.add(makeSubmap({0, 0, 1}, 3))->tf_idf, 0.0);  // every class is in every submap
  // Class 0 is in both submaps, class 2 in one of the two; 3 of the 4 landmarks are of class 2.
  EXPECT_NEAR(extractor.add(makeSubmap({0, 2, 2, 2}, 3))->tf_idf, 0.75 * std::log(2.0), 1e-12);
}

TEST(SubmapFeaturesTest, TfIdfIsNeverNegative) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    SubmapFeatureExtractor extractor(4);
    for (int i = 0; i < 50; ++i) {
      const auto a = static_cast<ClassIndex>((seed + i * i) % 4);
      const auto b = static_cast<ClassIndex>((seed * i) % 4);
      EXPECT_GE(extractor.add(makeSubmap({a, b, a}, 4))->tf_idf, 0.0);
    }
  }
}

TEST(SubmapFeaturesTest, LandmarksThatHardlyExistDoNotCount) {
  SubmapFeatureExtractor extractor(2);
  Submap submap = makeSubmap({0, 1}, 2);
  submap.landmarks.push_back(makeLandmark({9.0, 9.0, 9.0}, 1, 2, 0.1));
  EXPECT_EQ(extractor.add(submap)->landmarks, 2);
}

TEST(SubmapFeaturesTest, ASubmapWithoutLandmarksHasNoneButIsCounted) {
  SubmapFeatureExtractor extractor(2);
  EXPECT_FALSE(extractor.add(Submap{}).has_value());
  EXPECT_NEAR(extractor.add(makeSubmap({0}, 2))->tf_idf, std::log(2.0), 1e-12);
}

TEST(SubmapFeaturesTest, ImpossibleClassCountsThrow) {
  EXPECT_THROW(SubmapFeatureExtractor(0), std::invalid_argument);
  EXPECT_THROW(SubmapFeatureExtractor(kMaxClasses + 1), std::invalid_argument);
}

}  // namespace
}  // namespace semantic_mht_slam
