#include "g2o_line.h"

#include <charconv>
#include <cmath>
#include <optional>

#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/common/text.h"

namespace semantic_mht_slam {
namespace {

/// Reading doubles is most of the work for these files; the standard library's reader is four times faster than strtod
/// where it exists (GCC 11 and later).
std::optional<double> readDouble(std::string_view text) {
#ifdef __cpp_lib_to_chars
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  double value = 0.0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || stop != end) return std::nullopt;
  return value;
#else
  return parseDouble(text);
#endif
}

}  // namespace

G2oLine::G2oLine(std::string_view text, const std::string& file, int number)
    : rest_(text), file_(file), number_(number) {
  tag_ = std::string(word());
}

std::int64_t G2oLine::integer() {
  const std::string_view text = word();
  const std::optional<std::int64_t> value = parseInteger(text);
  if (!value) fail(text.empty() ? "too few fields" : "'" + std::string(text) + "' is not an integer");
  label_ += " " + std::string(text);
  return *value;
}

double G2oLine::number() {
  const std::string_view text = word();
  const std::optional<double> value = readDouble(text);
  if (!value) fail(text.empty() ? "too few fields" : "'" + std::string(text) + "' is not a number");
  if (!std::isfinite(*value)) fail("'" + std::string(text) + "' is not a finite number");
  return *value;
}

bool G2oLine::atEnd() {
  rest_ = trimmed(rest_);
  return rest_.empty();
}

void G2oLine::finish() {
  if (!atEnd()) fail("too many fields");
}

std::string G2oLine::name() const {
  return file_ + ":" + std::to_string(number_) + ": " + tag_ + label_;
}

void G2oLine::fail(const std::string& what) const {
  throw InputError(name() + ": " + what);
}

std::string_view G2oLine::word() {
  const auto is_blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  std::size_t begin = 0;
  while (begin < rest_.size() && is_blank(rest_[begin])) ++begin;
  std::size_t end = begin;
  while (end < rest_.size() && !is_blank(rest_[end])) ++end;
  const std::string_view result = rest_.substr(begin, end - begin);
  rest_.remove_prefix(end);
  return result;
}

void appendNumber(std::string& text, double value) {
#ifdef __cpp_lib_to_chars
  char buffer[32];
  text.push_back(' ');
  text.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr);
#else
  text.push_back(' ');
  text += formatDouble(value);
#endif
}

}  // namespace semantic_mht_slam
