// Without a prior: any heading, and the two origins not far from each other.
#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "semantic_mht_slam/registration/registration.h"

#include "registration/registration_test_util.h"

namespace semantic_mht_slam {
namespace {

using namespace testing;  // NOLINT(google-build-using-namespace): the worlds of these tests

constexpr double kStddev_m = 0.05;

/// Points of three classes along a street of 80 m by 30 m, wherever they fall.
Points openStreet(int count, Rng& rng) {
  Points points;
  for (int i = 0; i < count; ++i) {
    points.push_back(point({rng.uniform(-40.0, 40.0), rng.uniform(-15.0, 15.0), rng.uniform(-0.3, 0.3)},
                           static_cast<ClassIndex>(rng.index(3)), kStddev_m));
  }
  return points;
}

Points seenFrom(const Points& points, const Pose& T_a_b, Rng& rng) {
  Points seen = moved(points, T_a_b.inverse());
  for (RegistrationPoint& p : seen) {
    for (int axis = 0; axis < 3; ++axis) p.position_m(axis) += rng.normal(0.0, kStddev_m);
  }
  return seen;
}

Pose planarPose(double x_m, double y_m, double yaw_rad) {
  return {expRotation({0.0, 0.0, yaw_rad}), {x_m, y_m, 0.0}};
}

class OpenRegistrationSearchTest : public ::testing::TestWithParam<RegistrationSearch> {
 protected:
  OpenRegistrationSearchTest() { config_.search = GetParam(); }

  void expectFound(const Points& a, const Points& b, const Pose& T_a_b, int seed) const {
    const auto found = align(a, b, std::nullopt, classTable(), config_);
    ASSERT_FALSE(found.empty()) << "seed " << seed;
    const auto error = errorOf(found.front().T_a_b, T_a_b);
    EXPECT_LT(error.head<2>().norm(), 0.3) << "seed " << seed;
    EXPECT_LT(error.tail<3>().norm(), 0.04) << "seed " << seed;
  }

  RegistrationConfig config_;
};

TEST_P(OpenRegistrationSearchTest, FindsTheMotionInTheOppositeDirectionOfTravel) {
  for (int seed = 0; seed < 20; ++seed) {
    Rng rng(seed);
    const Points a = openStreet(30, rng);
    const Pose T_a_b = planarPose(rng.uniform(-4.0, 4.0), rng.uniform(-4.0, 4.0), M_PI + rng.normal(0.0, 0.1));
    expectFound(a, seenFrom(a, T_a_b, rng), T_a_b, seed);
  }
}

TEST_P(OpenRegistrationSearchTest, SurvivesPartialOverlapAndCarsThatLeft) {
  for (int seed = 0; seed < 20; ++seed) {
    Rng rng(100 + seed);
    const Points world = openStreet(60, rng);
    const Pose T_a_b = planarPose(rng.uniform(-5.0, 5.0), rng.uniform(-3.0, 3.0), rng.uniform(-M_PI, M_PI));
    Points b = seenFrom(world, T_a_b, rng);
    Points a = world;
    const auto left = [&](const RegistrationPoint& p) { return p.class_index == kVehicle && rng.bernoulli(0.6); };
    b.erase(std::remove_if(b.begin(), b.end(), left), b.end());
    const auto beyond = [](const RegistrationPoint& p) { return p.position_m.x() > 15.0; };
    a.erase(std::remove_if(a.begin(), a.end(), beyond), a.end());
    expectFound(a, b, T_a_b, seed);
  }
}

INSTANTIATE_TEST_SUITE_P(Searches, OpenRegistrationSearchTest,
                         ::testing::Values(RegistrationSearch::kVotes, RegistrationSearch::kClique,
                                           RegistrationSearch::kRansac));

TEST(OpenRegistrationTest, EverySearchFindsAnOffsetNearAPrior) {
  for (const auto search : {RegistrationSearch::kVotes, RegistrationSearch::kClique, RegistrationSearch::kRansac}) {
    RegistrationConfig config;
    config.search = search;
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
      const World w = world(seed, 0.05);
      const auto found = align(w, config);
      ASSERT_FALSE(found.empty()) << seed;
      EXPECT_LT(difference(found[0].T_a_b, w.T_a_b).head<2>().norm(), 0.3) << seed;
    }
  }
}

TEST(OpenRegistrationTest, SurvivesFourWrongPointsForEachRightOne) {
  for (int seed = 0; seed < 20; ++seed) {
    Rng rng(200 + seed);
    const Points common = openStreet(12, rng);
    const Pose T_a_b = planarPose(rng.uniform(-4.0, 4.0), rng.uniform(-4.0, 4.0), rng.uniform(-M_PI, M_PI));
    Points b = seenFrom(common, T_a_b, rng);
    Points a = common;
    for (const RegistrationPoint& p : openStreet(48, rng)) b.push_back(p);
    for (const RegistrationPoint& p : openStreet(48, rng)) a.push_back(p);
    const auto found = align(a, b, std::nullopt, classTable(), {});
    ASSERT_FALSE(found.empty());
    EXPECT_LT(errorOf(found.front().T_a_b, T_a_b).head<2>().norm(), 0.4) << "seed " << seed;
  }
}

TEST(OpenRegistrationTest, OneClassIsEnough) {
  for (int seed = 0; seed < 20; ++seed) {
    Rng rng(300 + seed);
    Points a = openStreet(25, rng);
    for (RegistrationPoint& p : a) p.class_index = kPole;
    const Pose T_a_b = planarPose(rng.uniform(-4.0, 4.0), rng.uniform(-4.0, 4.0), rng.uniform(-M_PI, M_PI));
    const auto found = align(a, seenFrom(a, T_a_b, rng), std::nullopt, classTable(), {});
    ASSERT_FALSE(found.empty()) << "seed " << seed;
    EXPECT_LT(errorOf(found.front().T_a_b, T_a_b).head<2>().norm(), 0.3) << "seed " << seed;
  }
}

TEST(OpenRegistrationTest, ARowOfEqualPointsHasSeveralModes) {
  Rng rng(9);
  Points row;
  for (int i = 0; i < 16; ++i) row.push_back(point({5.0 * (i / 2), i % 2 == 0 ? 8.0 : -8.0, 0.0}, kPole));
  const auto found = align(row, row, std::nullopt, classTable(), {});
  ASSERT_GE(found.size(), 3U);  // as it is, turned round, shifted by one
  for (std::size_t i = 0; i < found.size(); ++i) {
    for (std::size_t k = i + 1; k < found.size(); ++k) {
      const auto apart = errorOf(found[i].T_a_b, found[k].T_a_b);
      EXPECT_TRUE(apart.head<2>().norm() > 0.4 || std::abs(apart(5)) > 0.01) << i << " and " << k;
    }
    if (i > 0) {
      EXPECT_LE(found[i].log_evidence, found[i - 1].log_evidence);
    }
  }
}

TEST(OpenRegistrationTest, AnotherPlaceIsNoneOfThese) {
  int believed = 0;
  for (int seed = 0; seed < 100; ++seed) {
    Rng rng(400 + seed);
    believed += !align(openStreet(30, rng), openStreet(30, rng), std::nullopt, classTable(), {}).empty();
  }
  EXPECT_LE(believed, 5);
}

TEST(OpenRegistrationTest, StaysWithinTheLargestOffset) {
  Rng rng(10);
  const Points a = openStreet(30, rng);
  RegistrationConfig config;
  for (const double x_m : {7.0, 8.0}) {
    const bool is_found =
        !align(a, seenFrom(a, planarPose(x_m, 0.0, 1.0), rng), std::nullopt, classTable(), config).empty();
    EXPECT_EQ(is_found, x_m <= config.max_offset_m) << x_m;
  }
}

TEST(OpenRegistrationTest, OrderOfPointsChangesNothing) {
  Rng rng(6);
  const Points a = openStreet(30, rng);
  const Points b = seenFrom(a, planarPose(1.0, 2.0, 2.0), rng);
  const Points reversed(b.rbegin(), b.rend());
  for (const auto search : {RegistrationSearch::kVotes, RegistrationSearch::kClique, RegistrationSearch::kRansac}) {
    RegistrationConfig config;
    config.search = search;
    const auto expected = align(a, b, std::nullopt, classTable(), config);
    const auto actual = align(a, reversed, std::nullopt, classTable(), config);
    ASSERT_FALSE(expected.empty());
    ASSERT_EQ(actual.size(), expected.size());
    EXPECT_EQ(actual[0].T_a_b.matrix(), expected[0].T_a_b.matrix());
    EXPECT_EQ(actual[0].log_evidence, expected[0].log_evidence);
    EXPECT_EQ(actual[0].cov, expected[0].cov);
  }
}

TEST(OpenRegistrationTest, TurningEitherSideTurnsTheAnswer) {
  for (int seed = 0; seed < 20; ++seed) {
    Rng rng(500 + seed);
    const Points a = openStreet(30, rng);
    const Pose T_a_b = planarPose(1.0, -2.0, rng.uniform(-M_PI, M_PI));
    const Points b = seenFrom(a, T_a_b, rng);
    const Pose T_new_a = planarPose(0.0, 0.0, rng.uniform(-M_PI, M_PI));
    const auto expected = align(a, b, std::nullopt, classTable(), {});
    const auto actual = align(moved(a, T_new_a), b, std::nullopt, classTable(), {});
    ASSERT_FALSE(expected.empty());
    ASSERT_FALSE(actual.empty());
    EXPECT_LT(errorOf(actual[0].T_a_b, T_new_a * expected[0].T_a_b).norm(), 1e-3) << "seed " << seed;
    EXPECT_NEAR(actual[0].log_evidence, expected[0].log_evidence, 1e-2) << "seed " << seed;
  }
}

TEST(OpenRegistrationTest, NothingAndSinglePointsHaveNoMotion) {
  Rng rng(7);
  const Points street = openStreet(20, rng);
  const Points one = {street.front()};
  EXPECT_TRUE(align(street, {}, std::nullopt, classTable(), {}).empty());
  EXPECT_TRUE(align({}, street, std::nullopt, classTable(), {}).empty());
  EXPECT_TRUE(align(street, one, std::nullopt, classTable(), {}).empty());
}

}  // namespace
}  // namespace semantic_mht_slam
