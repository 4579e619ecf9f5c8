#pragma once

#include "semantic_mht_slam/map/landmark.h"

namespace semantic_mht_slam {

/// The landmark with seven digits to each number, many more than are known of it: what is beyond would be noise, and
/// half of a map file. A covariance that is not positive with seven digits keeps all of them.
MixtureLandmark withSevenDigits(MixtureLandmark landmark);

}  // namespace semantic_mht_slam
