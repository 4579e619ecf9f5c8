#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

// Numbers as text and back by integers, which is exact and much faster than the C library. What does not fit into 128
// bits is left to that.
namespace semantic_mht_slam {

/// A number as its significant digits.
struct Decimal {
  bool is_negative = false;
  std::uint64_t digits = 0;  ///< as many as `precision`
  int precision = 0;         ///< 15 to 17
  int exponent = 0;          ///< of the first digit
};

/// With 15 digits, or as many more as tell the number from its neighbours, rounded to the nearest, halves to even;
/// empty for what is far from 1, and for 0.
std::optional<Decimal> shortestDecimal(double value);

/// As printf's %g writes it.
std::string toText(const Decimal& decimal);

/// As printf's %f writes it with so many decimals, without the sign of what is rounded to 0; empty for what is far
/// from 1.
std::optional<std::string> toFixedText(double value, int decimals);

/// The number that a text of few digits is nearest to; empty for any other text, such as none of a number.
std::optional<double> parseShortDecimal(std::string_view text);

}  // namespace semantic_mht_slam
