#include "semantic_mht_slam/simulation/wander.h"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

namespace semantic_mht_slam {
namespace {

TEST(WanderTest, HasTheGivenDeviationAndCorrelation) {
  Rng rng(1);
  const int runs = 20000;
  double first_squares = 0.0;
  double last_squares = 0.0;
  double products = 0.0;
  for (int i = 0; i < runs; ++i) {
    Wander wander(2.0, 10.0, rng);
    const double first = wander.value();
    for (int step = 0; step < 5; ++step) wander.next(2.0, rng);
    first_squares += first * first;
    last_squares += wander.value() * wander.value();
    products += first * wander.value();
  }
  EXPECT_NEAR(first_squares / runs, 4.0, 0.16);  // four deviations of the mean of 20000 squares
  EXPECT_NEAR(last_squares / runs, 4.0, 0.16);
  EXPECT_NEAR(products / runs, 4.0 * std::exp(-1.0), 0.13);
}

TEST(WanderTest, StaysWhereNothingPasses) {
  Rng rng(1);
  Wander wander(1.0, 5.0, rng);
  const double value = wander.value();
  EXPECT_EQ(wander.next(0.0, rng), value);
}

TEST(WanderTest, RefusesACorrelationOfZero) {
  Rng rng(1);
  EXPECT_THROW(Wander(1.0, 0.0, rng), std::invalid_argument);
}

}  // namespace
}  // namespace semantic_mht_slam
