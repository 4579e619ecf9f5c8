#include "semantic_mht_slam/mapping/association_posterior.h"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "mapping/association_test_util.h"

namespace semantic_mht_slam {
namespace {

using association_test::makeMeasurement;
using association_test::makeTable;

/// Sums over every way to give each measurement a landmark of its own or none.
std::vector<std::vector<double>> enumerated(const std::vector<std::vector<AssociationOdds>>& odds, int landmarks) {
  std::vector<std::vector<double>> sums;
  for (const auto& row : odds) sums.emplace_back(row.size(), 0.0);
  std::vector<int> choice(odds.size(), -1);
  double all = 0.0;
  const std::function<void(std::size_t, double, std::vector<char>)> choose = [&](std::size_t i, double weight,
                                                                                 std::vector<char> taken) {
    if (i == odds.size()) {
      all += weight;
      for (std::size_t k = 0; k < choice.size(); ++k) {
        if (choice[k] >= 0) sums[k][static_cast<std::size_t>(choice[k])] += weight;
      }
      return;
    }
    choice[i] = -1;
    choose(i + 1, weight, taken);
    for (std::size_t c = 0; c < odds[i].size(); ++c) {
      const auto landmark = static_cast<std::size_t>(odds[i][c].landmark);
      if (taken[landmark] != 0) continue;
      choice[i] = static_cast<int>(c);
      std::vector<char> now = taken;
      now[landmark] = 1;
      choose(i + 1, weight * odds[i][c].sole, now);
    }
  };
  choose(0, 1.0, std::vector<char>(static_cast<std::size_t>(landmarks), 0));
  for (auto& row : sums) {
    for (double& sum : row) sum /= all;
  }
  return sums;
}

TEST(AssociationMarginalsTest, AreThoseOfAllAssignmentsWhereTheGraphHasNoLoop) {
  const std::vector<std::vector<AssociationOdds>> odds = {
      {{0, 5.0, 0.0}, {1, 2.0, 0.0}}, {{1, 3.0, 0.0}, {2, 0.5, 0.0}}, {{2, 40.0, 0.0}}};
  const auto marginals = associationMarginals(odds, 3);
  const auto expected = enumerated(odds, 3);
  for (std::size_t i = 0; i < odds.size(); ++i) {
    for (std::size_t c = 0; c < odds[i].size(); ++c) EXPECT_NEAR(marginals[i][c], expected[i][c], 1e-3) << i << c;
  }
}

TEST(AssociationMarginalsTest, AreNearThemWhereItHasOne) {
  const std::vector<std::vector<AssociationOdds>> odds = {{{0, 5.0, 0.0}, {1, 4.0, 0.0}},
                                                          {{0, 6.0, 0.0}, {1, 3.0, 0.0}}};
  const auto marginals = associationMarginals(odds, 2);
  const auto expected = enumerated(odds, 2);
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t c = 0; c < 2; ++c) EXPECT_NEAR(marginals[i][c], expected[i][c], 0.1) << i << c;
  }
}

TEST(AssociationMarginalsTest, TwoPartsOfOneObjectDoNotExcludeEachOther) {
  const std::vector<std::vector<AssociationOdds>> odds = {{{0, 100.0, 20.0}}, {{0, 100.0, 20.0}}};
  for (const auto& row : associationMarginals(odds, 1)) EXPECT_GT(row[0], 0.9);
}

MixtureLandmark makeLandmark(LandmarkId id, double x, double existence_prob, int observations) {
  MixtureLandmark landmark;
  landmark.id = id;
  landmark.position = {{x, 0.0, 0.0}, 0.01 * Eigen::Matrix3d::Identity()};
  landmark.components = {{1.0, landmark.position}};
  landmark.class_probs = ClassProbs::Zero(3);
  landmark.class_probs[0] = 1.0;
  landmark.existence_prob = existence_prob;
  landmark.observations = observations;
  return landmark;
}

class AssociationPosteriorTest : public testing::Test {
 protected:
  JudgedAssociation judged(std::vector<std::pair<MixtureLandmark, double>> landmarks, double x, LandmarkId assigned) {
    AssociationPosterior posterior(config_, model_, rate_, std::move(landmarks));
    return posterior.judge({makeMeasurement(x, 0)}, 0.0, {assigned}).at(0);
  }

  std::vector<AssociationAlternative> alternatives(std::vector<std::pair<MixtureLandmark, double>> landmarks, double x,
                                                   LandmarkId assigned) {
    AssociationPosterior posterior(config_, model_, rate_, std::move(landmarks));
    const Measurement measurement = makeMeasurement(x, 0);
    posterior.judge({measurement}, 0.0, {assigned});
    return posterior.alternatives(0, measurement, 0.0);
  }

  const MapperConfig config_;
  const ClassTable table_ = makeTable();
  const AssociationModel model_{config_, table_};
  const DetectionRate rate_{config_.detection, table_.size()};
};

TEST_F(AssociationPosteriorTest, ADetectionAtAWellKnownLandmarkIsOfIt) {
  const JudgedAssociation association = judged({{makeLandmark(1, 5.0, 0.999, 20), 0.0}}, 5.05, 1);
  EXPECT_GT(association.own_prob, 0.99);
  EXPECT_LT(association.nothing_prob, 0.01);
}

TEST_F(AssociationPosteriorTest, OneFarFromItsLandmarkIsClutterOrSo) {
  EXPECT_LT(judged({{makeLandmark(1, 5.0, 0.999, 20), 0.0}}, 5.9, 1).own_prob,
            judged({{makeLandmark(1, 5.0, 0.999, 20), 0.0}}, 5.3, 1).own_prob);
}

TEST_F(AssociationPosteriorTest, BetweenTwoLandmarksItMayBeOfEither) {
  const JudgedAssociation association =
      judged({{makeLandmark(1, 5.0, 0.999, 20), 0.0}, {makeLandmark(2, 5.4, 0.999, 20), 0.0}}, 5.2, 1);
  EXPECT_GT(association.own_prob, 0.3);
  EXPECT_LT(association.own_prob, 0.7);
  EXPECT_LT(association.nothing_prob, 0.05);
}

TEST_F(AssociationPosteriorTest, TheOnlySightingOfALandmarkIsNothingAsFarAsThatIsNot) {
  const JudgedAssociation association = judged({{makeLandmark(1, 5.0, 0.2, 1), 0.0}}, 5.0, 1);
  EXPECT_NEAR(association.nothing_prob, 0.8, 0.02);
  EXPECT_GT(association.own_prob, 0.98) << "if the landmark is there, it is of it";
}

TEST_F(AssociationPosteriorTest, WithoutALandmarkNearItIsNothing) {
  const JudgedAssociation association = judged({{makeLandmark(1, 5.0, 0.999, 20), 0.0}}, 25.0, kNoLandmark);
  EXPECT_EQ(association.nothing_prob, 1.0);
}

TEST_F(AssociationPosteriorTest, AlternativesSayWhatSpeaksForEach) {
  MixtureLandmark other = makeLandmark(2, 5.6, 0.7, 7);
  other.class_probs << 0.5, 0.5, 0.0;
  const auto all = alternatives({{makeLandmark(1, 5.0, 0.999999, 20), 0.0}, {other, 0.0}}, 5.4, 1);
  ASSERT_EQ(all.size(), 3U);
  double sum = 0.0;
  for (const AssociationAlternative& alternative : all) sum += alternative.probability;
  EXPECT_NEAR(sum, 1.0, 1e-9);
  EXPECT_EQ(all[0].landmark, 2U) << "the likeliest comes first";
  EXPECT_EQ(all[1].landmark, 1U);
  EXPECT_EQ(all[2].landmark, kNoLandmark);
  EXPECT_NEAR(all[0].distance_sigma, 0.2 / std::sqrt(0.02), 1e-6);
  EXPECT_NEAR(all[1].distance_sigma, 0.4 / std::sqrt(0.02), 1e-6);
  EXPECT_EQ(all[0].observations, 7);
  EXPECT_NEAR(all[0].log_count_prior, std::log(7.0), 1e-12);
  EXPECT_LT(all[0].log_class, all[1].log_class) << "half of what it is are other classes";
  EXPECT_LT(all[0].log_expected, all[1].log_expected) << "it may not exist";
  for (int i = 0; i < 2; ++i) {
    const AssociationAlternative& alternative = all[static_cast<std::size_t>(i)];
    const double log_odds = alternative.log_expected + alternative.log_place + alternative.log_class;
    EXPECT_NEAR(std::log(alternative.probability / all[2].probability), log_odds, 0.1) << i;
  }
}

TEST_F(AssociationPosteriorTest, WithoutALandmarkNearNothingIsTheOnlyAlternative) {
  const auto all = alternatives({{makeLandmark(1, 5.0, 0.999, 20), 0.0}}, 25.0, kNoLandmark);
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].landmark, kNoLandmark);
  EXPECT_EQ(all[0].probability, 1.0);
}

}  // namespace
}  // namespace semantic_mht_slam
