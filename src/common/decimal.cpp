#include "decimal.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace semantic_mht_slam {
namespace {

__extension__ using Wide = unsigned __int128;

constexpr int kLargestPower = 22;                          // of ten that is a double without loss
constexpr int kLargestScale = 32;                          // of five that is 128 bits with a mantissa
constexpr std::uint64_t kExact = std::uint64_t{1} << 53U;  // integers up to here are doubles without loss
constexpr int kMostDigits = 17;
constexpr int kMantissaBits = 53;
constexpr int kWideBits = 128;

constexpr std::array<double, kLargestPower + 1> kPowers = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                                           1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                                           1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

constexpr std::array<std::uint64_t, 18> kIntegerPowers = [] {
  std::array<std::uint64_t, 18> powers{1};
  for (std::size_t i = 1; i < powers.size(); ++i) powers[i] = 10 * powers[i - 1];
  return powers;
}();

constexpr std::array<Wide, kLargestScale + 1> kFives = [] {
  std::array<Wide, kLargestScale + 1> powers{1};
  for (std::size_t i = 1; i < powers.size(); ++i) powers[i] = 5 * powers[i - 1];
  return powers;
}();

/// A positive number as mantissa * 2^exponent.
struct Binary {
  std::uint64_t mantissa;
  int exponent;
};

Binary binaryOf(double value) {
  int exponent = 0;
  const double fraction = std::frexp(value, &exponent);
  return {static_cast<std::uint64_t>(std::ldexp(fraction, kMantissaBits)), exponent - kMantissaBits};
}

/// A number times a power of ten, rounded.
struct Scaled {
  std::uint64_t integer;
  bool reads_back;  ///< no other number is nearer to it
};

/// value * 10^power to the nearest integer, halves to even; empty if 128 bits do not hold it.
std::optional<Scaled> scaled(const Binary& value, int power) {
  const int shift = -value.exponent - power;
  if (power < 0 || power > kLargestScale || shift < 1 || shift >= kWideBits - 1) return std::nullopt;
  const Wide five = kFives[static_cast<std::size_t>(power)];
  const Wide product = value.mantissa * five;
  const Wide rest = product & ((Wide{1} << shift) - 1);
  const Wide half = Wide{1} << (shift - 1);
  const Wide below = product >> shift;
  if (below >> 62 != 0) return std::nullopt;
  const auto integer = static_cast<std::uint64_t>(below);
  const bool is_up = rest > half || (rest == half && (integer & 1) == 1);
  const Wide error = is_up ? 2 * half - rest : rest;
  return Scaled{integer + (is_up ? 1 : 0), 2 * error < five};
}

/// Rounded to `precision` digits.
std::optional<Scaled> rounded(const Binary& binary, int precision, int& exponent) {
  const auto digits = static_cast<std::size_t>(precision);
  auto result = scaled(binary, precision - 1 - exponent);
  if (result && result->integer < kIntegerPowers[digits - 1]) result = scaled(binary, precision - 1 - --exponent);
  if (result && result->integer >= kIntegerPowers[digits]) result = scaled(binary, precision - 1 - ++exponent);
  return result;
}

bool isDigit(char c) {
  return c >= '0' && c <= '9';
}

/// Reads digits onto a number; as many as are more than it can hold without loss are the caller's affair.
std::size_t readDigits(std::string_view& text, std::uint64_t& number) {
  std::size_t count = 0;
  for (; count < text.size() && isDigit(text[count]); ++count) {
    if (number >= kExact) return std::string_view::npos;
    number = 10 * number + static_cast<std::uint64_t>(text[count] - '0');
  }
  text.remove_prefix(count);
  return count;
}

bool readSign(std::string_view& text) {
  const bool is_negative = !text.empty() && text.front() == '-';
  if (is_negative || (!text.empty() && text.front() == '+')) text.remove_prefix(1);
  return is_negative;
}

/// What stands behind an e; empty for anything else, and for nothing.
std::optional<int> readExponent(std::string_view text) {
  if (text.front() != 'e' && text.front() != 'E') return std::nullopt;
  text.remove_prefix(1);
  const bool is_negative = readSign(text);
  std::uint64_t number = 0;
  const std::size_t count = readDigits(text, number);
  if (count == 0 || count > 4 || !text.empty()) return std::nullopt;
  return is_negative ? -static_cast<int>(number) : static_cast<int>(number);
}

}  // namespace

std::optional<Decimal> shortestDecimal(double value) {
  const double size = std::abs(value);
  if (!(size > 1e-300 && size < 1e15)) return std::nullopt;
  const Binary binary = binaryOf(size);
  if (binary.mantissa == std::uint64_t{1} << (kMantissaBits - 1)) return std::nullopt;  // neighbours unlike each other
  const int exponent = static_cast<int>(std::floor(std::log10(size)));
  for (int precision = 15; precision <= kMostDigits; ++precision) {
    Decimal decimal{value < 0.0, 0, precision, exponent};
    const auto digits = rounded(binary, precision, decimal.exponent);
    if (!digits) return std::nullopt;
    decimal.digits = digits->integer;
    if (digits->reads_back || precision == kMostDigits) return decimal;
  }
  return std::nullopt;
}

std::string toText(const Decimal& decimal) {
  std::array<char, 24> buffer{};
  const char* const end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), decimal.digits).ptr;
  std::string_view digits(buffer.data(), static_cast<std::size_t>(end - buffer.data()));
  digits = digits.substr(0, digits.find_last_not_of('0') + 1);
  const int exponent = decimal.exponent;
  std::string text(decimal.is_negative ? "-" : "");
  text.reserve(buffer.size());
  if (exponent < -4 || exponent >= decimal.precision) {
    text += digits.front();
    if (digits.size() > 1) text.append(".").append(digits.substr(1));
    const int size = std::abs(exponent);
    return text.append(exponent < 0 ? "e-" : "e+").append(size < 10 ? "0" : "").append(std::to_string(size));
  }
  if (exponent < 0) return text.append("0.").append(static_cast<std::size_t>(-exponent - 1), '0').append(digits);
  const auto whole = static_cast<std::size_t>(exponent) + 1;
  if (digits.size() <= whole) return text.append(digits).append(whole - digits.size(), '0');
  return text.append(digits.substr(0, whole)).append(".").append(digits.substr(whole));
}

std::optional<std::string> toFixedText(double value, int decimals) {
  const double size = std::abs(value);
  if (decimals < 0 || !(size < 1e15)) return std::nullopt;
  const auto number = size == 0.0 ? Scaled{0, true} : scaled(binaryOf(size), decimals);
  if (!number) return std::nullopt;
  std::array<char, 24> buffer{};
  const char* const end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), number->integer).ptr;
  std::string text(value < 0.0 && number->integer > 0 ? "-" : "");
  const auto digits = static_cast<std::size_t>(end - buffer.data());
  const auto least = static_cast<std::size_t>(decimals) + 1;
  if (digits < least) text.append(least - digits, '0');
  text.append(buffer.data(), digits);
  if (decimals > 0) text.insert(text.size() - least + 1, ".");
  return text;
}

std::optional<double> parseShortDecimal(std::string_view text) {
  const bool is_negative = readSign(text);
  std::uint64_t number = 0;
  const std::size_t whole = readDigits(text, number);
  if (whole == std::string_view::npos) return std::nullopt;
  std::size_t decimals = 0;
  if (!text.empty() && text.front() == '.') {
    text.remove_prefix(1);
    decimals = readDigits(text, number);
    if (decimals == std::string_view::npos) return std::nullopt;
  }
  if (whole + decimals == 0 || decimals > 100 || number > kExact) return std::nullopt;
  int exponent = 0;
  if (!text.empty()) {
    const std::optional<int> read = readExponent(text);
    if (!read) return std::nullopt;
    exponent = *read;
  }
  exponent -= static_cast<int>(decimals);
  if (std::abs(exponent) > kLargestPower) return std::nullopt;
  const double power = kPowers[static_cast<std::size_t>(std::abs(exponent))];
  const auto digits = static_cast<double>(number);
  const double value = exponent < 0 ? digits / power : digits * power;
  return is_negative ? -value : value;
}

}  // namespace semantic_mht_slam
