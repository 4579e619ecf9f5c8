#include "semantic_mht_slam/evaluation/statistics.h"

#include <cmath>

#include <gtest/gtest.h>

namespace semantic_mht_slam {
namespace {

TEST(StatisticsTest, FiguresOfAShortList) {
  const std::vector<double> values = {4.0, -1.0, 2.0, 3.0};
  EXPECT_DOUBLE_EQ(mean(values), 2.0);
  EXPECT_DOUBLE_EQ(rootMeanSquare(values), std::sqrt(30.0 / 4.0));
  EXPECT_DOUBLE_EQ(standardDeviation(values), std::sqrt(14.0 / 4.0));
  EXPECT_DOUBLE_EQ(median(values), 2.5);
  EXPECT_DOUBLE_EQ(median({9.0, 1.0, 5.0}), 5.0);
}

TEST(StatisticsTest, FiguresOfNothingAreNotNumbers) {
  EXPECT_TRUE(std::isnan(mean({})));
  EXPECT_TRUE(std::isnan(rootMeanSquare({})));
  EXPECT_TRUE(std::isnan(standardDeviation({})));
  EXPECT_TRUE(std::isnan(median({})));
}

}  // namespace
}  // namespace semantic_mht_slam
