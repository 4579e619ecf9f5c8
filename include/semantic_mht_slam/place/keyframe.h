#pragma once

#include <cstddef>

#include "semantic_mht_slam/place/scene.h"

namespace semantic_mht_slam {

/// A frame that stands for a place: chosen every few metres, with the scene around it.
struct Keyframe {
  std::size_t frame = 0;  ///< index of the detector frame
  int submap = 0;         ///< that the frame belongs to
  double driven_m = 0.0;  ///< travelled since the start of the drive
  Scene scene;            ///< base frame of this frame
};

}  // namespace semantic_mht_slam
