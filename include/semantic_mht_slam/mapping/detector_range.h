#pragma once

#include <optional>
#include <vector>

#include "semantic_mht_slam/models/detection.h"

namespace semantic_mht_slam {

class StateArchive;

/// How far the detector sees, from its first frames: all lengths that are not set follow it (see `Length`).
class DetectorRange {
 public:
  /// Takes a frame. True once enough was seen.
  bool add(const Detections& detections);

  /// How much farther than the reference nine of ten detections reach, as a power of two, so that small differences
  /// between drives change nothing; 1 without any detection.
  double factor() const;

  /// All that it has seen (see `StateArchive`).
  void transfer(StateArchive& archive);

 private:
  std::vector<double> ranges_m_;
  int frames_ = 0;  ///< with detections
};

}  // namespace semantic_mht_slam
