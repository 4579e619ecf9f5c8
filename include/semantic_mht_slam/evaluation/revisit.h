#pragma once

#include <cstddef>

namespace semantic_mht_slam {

/// A frame revisits a place if one at least so many frames earlier was within this distance, by the truth.
constexpr std::size_t kRevisitMinFrames = 200;
constexpr double kRevisitRadius_m = 3.0;

}  // namespace semantic_mht_slam
