#pragma once

#include <cstddef>
#include <vector>

namespace semantic_mht_slam {

/// At most `most` (>= 2) of the values: every one, or every 2nd, 4th, 8th, ... beginning with the first, and the last.
/// What is left out stays out when more are added, so that a growing line does not flicker.
template <class Vector>
Vector thinned(const Vector& values, std::size_t most) {
  if (values.size() <= most) return values;
  std::size_t stride = 2;
  while ((values.size() - 1) / stride + 2 > most) stride *= 2;
  Vector result;
  for (std::size_t i = 0; i + 1 < values.size(); i += stride) result.push_back(values[i]);
  result.push_back(values.back());
  return result;
}

}  // namespace semantic_mht_slam
