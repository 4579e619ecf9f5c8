#pragma once

#include <limits>

namespace semantic_mht_slam {

/// The value as an integer, cut to what one can hold with room for a neighbour; the least one for what is no number.
/// For values that come from outside: a plain cast of what does not fit is undefined.
inline int saturatedInt(double value) {
  constexpr int kMost = std::numeric_limits<int>::max() / 2;
  if (value >= kMost) return kMost;
  return value > -kMost ? static_cast<int>(value) : -kMost;
}

}  // namespace semantic_mht_slam
