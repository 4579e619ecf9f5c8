#include "semantic_mht_slam/registration/registration.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "registration/registration_test_util.h"

namespace semantic_mht_slam {
namespace {

using namespace testing;  // NOLINT(google-build-using-namespace): the worlds of these tests

TEST(RegistrationTest, FindsTheOffsetAndAllMatchesWithoutNoise) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const World w = world(seed, 0.0);
    const auto found = align(w);
    ASSERT_FALSE(found.empty()) << seed;
    EXPECT_LT(difference(found[0].T_a_b, w.T_a_b).head<3>().norm(), 1e-3) << seed;
    EXPECT_LT(std::abs(difference(found[0].T_a_b, w.T_a_b)(3)), 1e-3) << seed;
    EXPECT_EQ(counterparts(found[0], 20), counting(20)) << seed;
    EXPECT_GT(softPairs(found[0]), 18.0) << seed;
  }
}

TEST(RegistrationTest, ReturnsThePriorItselfWhenTheFramesAreEqual) {
  Rng rng(3);
  const Points points = street(20, rng);
  const auto found = align(points, points, RegistrationPrior{Pose::identity(), 4.0, 0.5, 0.03}, classTable(), {});
  ASSERT_FALSE(found.empty());
  EXPECT_LT(difference(found[0].T_a_b, Pose::identity()).norm(), 1e-9);
  EXPECT_EQ(counterparts(found[0], 20), counting(20));
}

TEST(RegistrationTest, DependsOnNoOrder) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const World w = world(seed, 0.1);
    Rng rng(seed + 1000);
    std::vector<int> detection_order = counting(20), landmark_order = counting(20);
    for (int i = 19; i > 0; --i) {
      std::swap(detection_order[i], detection_order[rng.index(i + 1)]);
      std::swap(landmark_order[i], landmark_order[rng.index(i + 1)]);
    }
    World shuffled = w;
    for (int i = 0; i < 20; ++i) {
      shuffled.detections[i] = w.detections[detection_order[i]];
      shuffled.landmarks[i] = w.landmarks[landmark_order[i]];
    }
    const auto expected = align(w);
    const auto actual = align(shuffled);
    ASSERT_EQ(actual.size(), expected.size());
    for (std::size_t h = 0; h < expected.size(); ++h) {
      EXPECT_EQ(actual[h].T_a_b.matrix(), expected[h].T_a_b.matrix());
      EXPECT_EQ(actual[h].log_evidence, expected[h].log_evidence);
      for (int i = 0; i < 20; ++i) {
        const int landmark = counterparts(actual[h], 20)[i];
        EXPECT_EQ(landmark < 0 ? -1 : landmark_order[landmark], counterparts(expected[h], 20)[detection_order[i]]);
      }
    }
  }
}

TEST(RegistrationTest, MovesWithTheWorldAndChangesNothingElse) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const World w = world(seed, 0.1);
    Rng rng(seed);
    const Pose T_new_a = {Eigen::Quaterniond(Eigen::AngleAxisd(rng.uniform(-3.0, 3.0), Eigen::Vector3d::UnitZ())),
                          {rng.uniform(-50.0, 50.0), rng.uniform(-50.0, 50.0), rng.uniform(-50.0, 50.0)}};
    World other = w;
    other.landmarks = moved(w.landmarks, T_new_a);
    other.prior.T_a_b = T_new_a * w.prior.T_a_b;
    const auto expected = align(w);
    const auto actual = align(other);
    ASSERT_EQ(actual.size(), expected.size()) << seed;
    for (std::size_t h = 0; h < expected.size(); ++h) {
      EXPECT_LT(difference(actual[h].T_a_b, T_new_a * expected[h].T_a_b).norm(), 1e-6);
      EXPECT_LT((actual[h].cov - expected[h].cov).norm(), 1e-8);  // in the frame of b
      EXPECT_NEAR(actual[h].log_evidence, expected[h].log_evidence, 1e-5);
      EXPECT_EQ(counterparts(actual[h], 20), counterparts(expected[h], 20));
    }
  }
}

TEST(RegistrationTest, KeepsTheTiltOfThePrior) {
  World w = world(5, 0.0);
  const Pose T_level_tilted = {Eigen::Quaterniond(Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitX())), {0.0, 0.0, 0.0}};
  w.detections = moved(w.detections, T_level_tilted.inverse());
  w.prior.T_a_b = w.prior.T_a_b * T_level_tilted;
  const auto found = align(w);
  ASSERT_FALSE(found.empty());
  EXPECT_LT(angularDistance(found[0].T_a_b.rotation, (w.T_a_b * T_level_tilted).rotation), 1e-3);
  EXPECT_EQ(counterparts(found[0], 20), counting(20));
}

TEST(RegistrationTest, SurvivesHalfOfTheDetectionsBeingElsewhere) {
  int wrong_offsets = 0;
  int wrong_matches = 0;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    World w = world(seed, 0.1);
    Rng rng(seed + 500);
    for (int i = 10; i < 20; ++i) {
      w.detections[i].position_m = {rng.uniform(-35.0, 35.0), rng.uniform(-12.0, 12.0), rng.uniform(-1.0, 1.0)};
    }
    const auto found = align(w);
    if (found.empty() || difference(found[0].T_a_b, w.T_a_b).head<2>().norm() > 0.3) {
      ++wrong_offsets;
      continue;
    }
    for (int i = 0; i < 10; ++i) wrong_matches += counterparts(found[0], 20)[i] != i;
  }
  EXPECT_EQ(wrong_offsets, 0);
  EXPECT_LE(wrong_matches, 10);  // of 500: a stray detection may lie on another's landmark
}

TEST(RegistrationTest, ReturnsBothOfTwoEquallyGoodOffsets) {
  World w;
  for (int i = 0; i < 6; ++i) w.landmarks.push_back(point({8.0 * i, 2.0 * (i % 2), 0.0}, kPole));
  for (int i = 0; i < 4; ++i) w.detections.push_back(w.landmarks[i]);  // repeats itself after 16 m: poles 2 to 5
  w.prior = {{Eigen::Quaterniond::Identity(), {8.0, 0.0, 0.0}}, 6.0, 0.3, 0.03};
  RegistrationConfig config;
  config.match_concentration = 1.0;
  const auto found = align(w, config);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_NEAR(found[0].log_evidence, found[1].log_evidence, 1e-6);
  const double near_m = std::min(found[0].T_a_b.translation_m.x(), found[1].T_a_b.translation_m.x());
  const double far_m = std::max(found[0].T_a_b.translation_m.x(), found[1].T_a_b.translation_m.x());
  EXPECT_NEAR(near_m, 0.0, 0.05);
  EXPECT_NEAR(far_m, 16.0, 0.05);
}

TEST(RegistrationTest, ReturnsNothingWithoutEnoughPoints) {
  const World w = world(1, 0.0);
  World no_detections = w, no_landmarks = w, one = w, two = w;
  no_detections.detections.clear();
  no_landmarks.landmarks.clear();
  one.detections.resize(1);
  two.detections.resize(2);
  for (const World& poor : {no_detections, no_landmarks, one, two}) EXPECT_TRUE(align(poor).empty());
}

TEST(RegistrationTest, ReturnsNothingWhenTheHeadingStaysOpen) {
  World w;
  for (int i = 0; i < 6; ++i) w.landmarks.push_back(point({10.0, 5.0, 1.5 * i}, kSign));  // one above the other
  w.detections = w.landmarks;
  for (RegistrationPoint& p : w.detections) p.position_m -= Eigen::Vector3d(10.0, 5.0, 0.0);
  w.prior = {{Eigen::Quaterniond::Identity(), {10.0, 5.0, 0.0}}, 4.0, 0.5, 0.03};
  EXPECT_TRUE(align(w).empty());
}

TEST(RegistrationTest, IsCertainAcrossARowOfPointsAndOfItsHeading) {
  World w;
  for (const double x : {0.0, 7.0, 11.0, 23.0, 29.0}) w.landmarks.push_back(point({x, 0.0, 0.0}, kPole));
  w.detections = w.landmarks;
  w.prior = {{Eigen::Quaterniond::Identity(), {1.5, 1.0, 0.0}}, 3.0, 0.3, 0.03};
  const auto found = align(w);
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(counterparts(found[0], 5), counting(5));
  EXPECT_LT(std::sqrt(found[0].headingCov()(1, 1)), 0.3);
  EXPECT_LT(std::sqrt(found[0].headingCov()(3, 3)), 0.02);
}

TEST(RegistrationTest, PrefersNotHereBeforeInAnotherPlace) {
  int believed = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    World w = world(seed, 0.1);
    Rng rng(seed + 7000);
    w.landmarks = moved(street(20, rng), w.T_a_b);
    believed += !align(w).empty();
  }
  EXPECT_LE(believed, 5);
}

TEST(RegistrationTest, NeverUsesALandmarkTwice) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    World w = world(seed, 0.1);
    const Points once = w.detections;
    for (RegistrationPoint split : once) {
      split.position_m.x() += 0.2;
      w.detections.push_back(split);
    }
    const auto found = align(w);
    ASSERT_FALSE(found.empty());
    std::vector<int> used = counterparts(found[0], 40);
    used.erase(std::remove(used.begin(), used.end(), -1), used.end());
    std::sort(used.begin(), used.end());
    EXPECT_EQ(std::unique(used.begin(), used.end()), used.end());
  }
}

TEST(RegistrationTest, MistakesClassesForEachOtherOnlyWhenAllowedAndBothStaticOrBothMovable) {
  World w = world(2, 0.0);
  w.landmarks[0].class_index = kSign;
  w.detections[0].class_index = kPole;
  w.landmarks[1].class_index = kVehicle;
  w.detections[1].class_index = kPole;
  w.landmarks[2].class_index = kVehicle;
  w.detections[2].class_index = kRider;
  RegistrationConfig config;
  config.confusion_prob = 0.2;
  const auto confused = align(w, config);
  config.confusion_prob = 0.0;
  const auto strict = align(w, config);
  ASSERT_FALSE(confused.empty());
  ASSERT_FALSE(strict.empty());
  EXPECT_EQ(counterparts(confused[0], 20)[0], 0);
  EXPECT_EQ(counterparts(confused[0], 20)[1], -1);
  EXPECT_EQ(counterparts(confused[0], 20)[2], 2);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(counterparts(strict[0], 20)[i], -1);
}

TEST(RegistrationTest, TrustsPolesMoreThanBuildings) {
  World w = world(4, 0.0);
  for (int i = 0; i < 20; ++i) {
    const ClassIndex c = i < 8 ? kPole : kBuilding;
    w.landmarks[i].class_index = w.detections[i].class_index = c;
    if (c == kBuilding) w.landmarks[i].position_m.x() += 1.5;  // all facades seen from elsewhere
  }
  const auto found = align(w);
  ASSERT_FALSE(found.empty());
  EXPECT_LT(difference(found[0].T_a_b, w.T_a_b).head<2>().norm(), 0.1);
}

TEST(RegistrationTest, RefusesBrokenInput) {
  const World w = world(1, 0.0);
  World bad_point = w, bad_cov = w, bad_class = w, bad_prior = w;
  bad_point.detections[3].position_m.y() = std::numeric_limits<double>::quiet_NaN();
  bad_cov.landmarks[3].cov_m2.setZero();
  bad_class.landmarks[3].class_index = 5;
  bad_prior.prior.stddev_yaw_rad = 0.0;
  for (const World& bad : {bad_point, bad_cov, bad_class, bad_prior}) EXPECT_THROW(align(bad), std::invalid_argument);
}

}  // namespace
}  // namespace semantic_mht_slam
