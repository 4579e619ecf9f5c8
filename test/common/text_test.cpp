#include "semantic_mht_slam/common/text.h"

#include <clocale>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

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

/// With as few of 15 to 17 digits as read back the same, by the C library.
std::string printed(double value) {
  char buffer[64];
  for (int digits = 15; digits <= 17; ++digits) {
    std::snprintf(buffer, sizeof buffer, "%.*g", digits, value);
    if (std::strtod(buffer, nullptr) == value) break;
  }
  return buffer;
}

TEST(TextTest, NumbersAreWrittenAndReadAsTheCLibraryDoes) {
  Rng rng(2);
  std::vector<double> values = {1.0,  -1.0,  0.5, 1e-4, 1e-5, 1e15, 1e16, 999999999999999.9, 9007199254740993.0,
                                1e22, 5e-324};
  for (int i = 0; i < 20000; ++i) {
    values.push_back(rng.normal() * std::pow(10.0, rng.uniform(-20.0, 20.0)));      // of any size
    values.push_back(std::round(1e3 * rng.normal(0.0, 100.0)) / 1e3);               // of few digits
    values.push_back(std::ldexp(std::round(rng.uniform(1.0, 8.0)), i % 100 - 50));  // of few bits
    values.push_back(static_cast<float>(rng.normal()));
  }
  for (const double value : values) {
    const std::string text = printed(value);
    ASSERT_EQ(formatDouble(value), text);
    ASSERT_EQ(parseDouble(text), std::strtod(text.c_str(), nullptr)) << text;
  }
  for (const char* text :
       {"5.", ".5", "+5", "-.5e3", "1E+2", "1e23", "0.1234567890123456789", "123456789012345678901", "0x10"}) {
    EXPECT_EQ(parseDouble(text), std::strtod(text, nullptr)) << text;
  }
  EXPECT_TRUE(std::signbit(parseDouble("-0").value()));
  for (const char* text : {".", "1e", "e5", "+-1", "1e+", "1.5.", "1e1.5"}) EXPECT_FALSE(parseDouble(text)) << text;
}

TEST(TextTest, FixedNumbersHaveNoNegativeZero) {
  EXPECT_EQ(formatFixed(-0.0004, 3), "0.000");
  EXPECT_EQ(formatFixed(-0.0006, 3), "-0.001");
  EXPECT_EQ(formatFixed(12.3456, 2), "12.35");
}

TEST(TextTest, FixedNumbersAreThoseOfTheCLibrary) {
  Rng rng(5);
  std::vector<double> values = {0.0, 0.5, 1.5, 0.125, 0.375, 0.0625, 1e-320, 1e-5, 999.9999999, 4e15, 1e22, 1e300};
  for (int i = 0; i < 20000; ++i) values.push_back(rng.uniform(-1.0, 1.0) * std::pow(10.0, rng.uniform(-12.0, 16.0)));
  for (int i = 0; i < 2000; ++i) values.push_back(std::ldexp(std::floor(rng.uniform(0.0, 5000.0)), -6));  // halves
  for (const double value : values) {
    for (const int decimals : {0, 1, 4, 8, 12}) {
      char text[400];
      std::snprintf(text, sizeof text, "%.*f", decimals, value);
      const bool is_zero = std::string(text).find_first_of("123456789") == std::string::npos;
      ASSERT_EQ(formatFixed(value, decimals), text + (is_zero && text[0] == '-' ? 1 : 0)) << value;
    }
  }
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
