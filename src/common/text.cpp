#include "semantic_mht_slam/common/text.h"

#include <algorithm>
#include <charconv>
#include <clocale>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numeric>

#include <locale.h>

#include "decimal.h"

namespace semantic_mht_slam {
namespace {

locale_t classicLocale() {
  static const locale_t locale = newlocale(LC_ALL_MASK, "C", nullptr);
  return locale;
}

bool isBlank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

/// printf in the classic locale, so that a decimal point is a point.
std::string printNumber(const char* format, int precision, double value) {
  char buffer[400];
  const locale_t previous = uselocale(classicLocale());
  const int length = std::snprintf(buffer, sizeof buffer, format, precision, value);
  uselocale(previous);
  return {buffer, static_cast<std::size_t>(length)};
}

std::size_t editDistance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t substituted = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({row[j] + 1, row[j + 1] + 1, substituted});
    }
  }
  return row.back();
}

}  // namespace

std::optional<double> parseDouble(std::string_view text) {
  char buffer[64];
  if (text.empty() || text.size() >= sizeof buffer || isBlank(text.front())) return std::nullopt;
  if (const std::optional<double> value = parseShortDecimal(text)) return value;
  std::copy(text.begin(), text.end(), buffer);
  buffer[text.size()] = '\0';
  char* end = nullptr;
  const double value = strtod_l(buffer, &end, classicLocale());
  if (end != buffer + text.size()) return std::nullopt;
  return value;
}

std::optional<std::int64_t> parseInteger(std::string_view text) {
  std::int64_t value = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || stop != end) return std::nullopt;
  return value;
}

std::string formatDouble(double value) {
  if (value == 0.0) return std::signbit(value) ? "-0" : "0";
  if (const std::optional<Decimal> decimal = shortestDecimal(value)) return toText(*decimal);
  for (int digits = 15; digits < 17; ++digits) {
    std::string text = printNumber("%.*g", digits, value);
    if (parseDouble(text) == value) return text;
  }
  return printNumber("%.*g", 17, value);
}

std::string formatFixed(double value, int decimals) {
  if (const auto fixed = toFixedText(value, decimals)) return *fixed;
  std::string text = printNumber("%.*f", decimals, value);
  if (text.front() == '-' && text.find_first_of("123456789") == std::string::npos) text.erase(0, 1);
  return text;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && isBlank(text.front())) text.remove_prefix(1);
  while (!text.empty() && isBlank(text.back())) text.remove_suffix(1);
  return text;
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> fields;
  while (true) {
    const std::size_t end = text.find(separator);
    fields.push_back(trimmed(text.substr(0, end)));
    if (end == std::string_view::npos) return fields;
    text.remove_prefix(end + 1);
  }
}

std::vector<std::string_view> splitBlanks(std::string_view text) {
  std::vector<std::string_view> fields;
  for (std::size_t i = 0; i < text.size();) {
    if (isBlank(text[i])) {
      ++i;
      continue;
    }
    std::size_t end = i;
    while (end < text.size() && !isBlank(text[end])) ++end;
    fields.push_back(text.substr(i, end - i));
    i = end;
  }
  return fields;
}

std::string joined(const std::vector<std::string>& items, std::string_view separator) {
  std::string result;
  for (const std::string& item : items) {
    if (&item != &items.front()) result += separator;
    result += item;
  }
  return result;
}

std::optional<std::string> closest(std::string_view word, const std::vector<std::string>& items) {
  const std::size_t limit = std::max<std::size_t>(1, word.size() / 3);
  std::optional<std::string> best;
  std::size_t best_distance = limit + 1;
  for (const std::string& item : items) {
    const std::size_t distance = editDistance(word, item);
    if (distance < best_distance) {
      best_distance = distance;
      best = item;
    }
  }
  return best;
}

}  // namespace semantic_mht_slam
