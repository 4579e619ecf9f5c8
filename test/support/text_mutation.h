#pragma once

#include <cctype>
#include <iterator>
#include <string>

#include "semantic_mht_slam/common/random.h"

namespace semantic_mht_slam {

/// Text in which another number stands in the place of one.
inline std::string withAnotherNumber(std::string text, Rng& rng) {
  constexpr const char* kNumbers[] = {"0",     "1",    "-1",     "2",   "3",          "0.5",
                                      "7",     "100",  "1e-9",   "1e7", "2147483647", "4294967296",
                                      "1e308", "-1e9", "1e-320", "nan", "inf",        "9223372036854775807"};
  const auto isOfNumber = [](char c) {
    return std::isdigit(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '-';
  };
  std::size_t begin = rng.index(text.size() + 1);
  while (begin < text.size() && !isOfNumber(text[begin])) ++begin;
  std::size_t end = begin;
  while (end < text.size() && isOfNumber(text[end])) ++end;
  while (begin > 0 && end > begin && isOfNumber(text[begin - 1])) --begin;
  return text.replace(begin, end - begin, kNumbers[rng.index(std::size(kNumbers))]);
}

/// Text with one thing changed that leaves most of it what it was: a number, a line that is missing, stands twice or
/// somewhere else.
inline std::string mutatedText(std::string text, Rng& rng) {
  if (text.empty() || rng.bernoulli(0.6)) return withAnotherNumber(std::move(text), rng);
  const auto beginOfLine = [&](std::size_t place) {
    while (place > 0 && text[place - 1] != '\n') --place;
    return place;
  };
  const std::size_t begin = beginOfLine(rng.index(text.size()));
  const std::size_t newline = text.find('\n', begin);
  const std::size_t size = (newline == std::string::npos ? text.size() : newline + 1) - begin;
  const std::string line = text.substr(begin, size);
  const std::uint64_t kind = rng.index(3);
  if (kind != 0) text.erase(begin, size);
  if (kind != 1) text.insert(beginOfLine(rng.index(text.size() + 1)), line);
  return text;
}

}  // namespace semantic_mht_slam
