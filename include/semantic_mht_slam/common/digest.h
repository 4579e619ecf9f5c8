#pragma once

#include <cstdint>

namespace semantic_mht_slam {

/// FNV-1a of a sequence of bytes.
template <class Bytes>
std::uint64_t digestOf(const Bytes& bytes) {
  std::uint64_t value = 0xCBF29CE484222325ULL;
  for (const auto byte : bytes) value = (value ^ static_cast<std::uint8_t>(byte)) * 0x100000001B3ULL;
  return value;
}

}  // namespace semantic_mht_slam
