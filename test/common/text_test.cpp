#include "semantic_mht_slam/common/text.h"

#include <clocale>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "semantic_mht_slam/common/random.h"

namespace semantic_mht_slam {
namespace {

TEST(TextTest, NumbersAreReadWholeOrNotAtAll) {
  EXPECT_EQ(parseDouble("-1.5e3"), -1500.0);
  EXPECT_TRUE(std::isnan(*parseDouble("nan")));
  for (const char* text : {"", " 1", "1 ", "1,5", "1.5x", "one", "--1"}) EXPECT_FALSE(parseDouble(text)) << text;
  EXPECT_EQ(parseInteger("-42"), -42);
  for (const char* text : {"", "4.0", "4x", " 4", "99999999999999999999"}) EXPECT_FALSE(parseInteger(text)) << text;
}

TEST(TextTest, FormattedNumbersReadBackTheSame) {
  Rng rng(1);
  for (int i = 0; i < 1000; ++i) {
    const double value = rng.normal() * std::pow(10.0, rng.uniform(-20.0, 20.0));
    EXPECT_EQ(parseDouble(formatDouble(value)), value);
  }
  EXPECT_EQ(formatDouble(0.1), "0.1");
  EXPECT_EQ(formatDouble(30.0), "30");
  EXPECT_EQ(parseDouble(formatDouble(std::numeric_limits<double>::denorm_min())),
            std::numeric_limits<double>::denorm_min());
}

TEST(TextTest, FixedNumbersHaveNoNegativeZero) {
  EXPECT_EQ(formatFixed(-0.0004, 3), "0.000");
  EXPECT_EQ(formatFixed(-0.0006, 3), "-0.001");
  EXPECT_EQ(formatFixed(12.3456, 2), "12.35");
}

TEST(TextTest, SplitKeepsEmptyFieldsAndSplitBlanksDoesNot) {
  EXPECT_EQ(split("a, ,b,", ',').size(), 4U);
  EXPECT_EQ(split("a, ,b,", ',')[1], "");
  EXPECT_EQ(splitBlanks("  1 \t 2\r").size(), 2U);
  EXPECT_TRUE(splitBlanks("").empty());
}

TEST(TextTest, ClosestFindsMisspellingsOnly) {
  EXPECT_EQ(closest("submap_lenght", {"seed", "submap_length"}), "submap_length");
  EXPECT_FALSE(closest("gate", {"seed", "submap_length"}));
}

}  // namespace
}  // namespace semantic_mht_slam
