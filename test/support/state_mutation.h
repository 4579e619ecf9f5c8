#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>

#include "semantic_mht_slam/common/random.h"

namespace semantic_mht_slam {

/// Bytes of a `StateArchive` in which another double stands wherever `from` stood; as they are if it is not there.
inline std::string withNumber(std::string bytes, double from, double to) {
  std::size_t count = 0;
  std::size_t place = 0;
  for (unsigned shift = 0; place < bytes.size(); shift += 7) {
    const auto part = static_cast<unsigned char>(bytes[place++]);
    count |= static_cast<std::size_t>(part & 127U) << shift;
    if ((part & 128U) == 0) break;
  }
  for (std::size_t i = 0; i < count; ++i) {
    std::array<char, sizeof(double)> number{};
    for (std::size_t k = 0; k < number.size(); ++k) number[k] = bytes.at(place + k * count + i);
    if (std::memcmp(number.data(), &from, sizeof from) != 0) continue;
    std::memcpy(number.data(), &to, sizeof to);
    for (std::size_t k = 0; k < number.size(); ++k) bytes[place + k * count + i] = number[k];
  }
  return bytes;
}

/// Bytes of a `StateArchive` with one thing changed: a bit, a number by one that nobody expects, a count, or a piece
/// that is missing or stands twice.
inline std::string mutated(std::string bytes, Rng& rng) {
  if (bytes.empty()) return bytes;
  const std::size_t place = rng.index(bytes.size());
  const auto writeNumber = [&](double value) {
    if (place + sizeof value <= bytes.size()) std::memcpy(&bytes[place], &value, sizeof value);
  };
  switch (rng.index(6)) {
    case 0:
      bytes[place] ^= static_cast<char>(1U << rng.index(8));
      break;
    case 1: {
      constexpr double kNumbers[] = {std::numeric_limits<double>::quiet_NaN(),
                                     std::numeric_limits<double>::infinity(),
                                     1e308,
                                     -1e308,
                                     1e20,
                                     -1.0,
                                     0.0,
                                     1e-300};
      writeNumber(kNumbers[rng.index(8)]);
      break;
    }
    case 2: {
      double value = 0.0;
      if (place + sizeof value <= bytes.size()) std::memcpy(&value, &bytes[place], sizeof value);
      writeNumber(value * (rng.bernoulli(0.5) ? -1.0 : rng.uniform(0.5, 1e6)));
      break;
    }
    case 3: {  // an integer, zigzag coded
      constexpr std::int64_t kIntegers[] = {-1, 0, 1, 2, 1000, 100000000, 1LL << 40, INT64_MAX, INT64_MIN};
      const std::int64_t value = kIntegers[rng.index(9)];
      auto code = (static_cast<std::uint64_t>(value) << 1U) ^ static_cast<std::uint64_t>(value >> 63);
      std::string text;
      for (; code >= 128; code >>= 7U) text.push_back(static_cast<char>((code & 127U) | 128U));
      text.push_back(static_cast<char>(code));
      bytes.replace(place, 1, text);
      break;
    }
    case 4:
      bytes.erase(place, 1 + rng.index(16));
      break;
    default:
      bytes.insert(place, bytes.substr(rng.index(bytes.size()), 1 + rng.index(16)));
  }
  return bytes;
}

}  // namespace semantic_mht_slam
