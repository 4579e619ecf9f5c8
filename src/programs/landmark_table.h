#pragma once

#include <string>
#include <vector>

#include "semantic_mht_slam/common/text.h"
#include "semantic_mht_slam/map/landmark.h"
#include "semantic_mht_slam/models/class_table.h"

namespace semantic_mht_slam {

/// Landmarks as landmarks.csv has them (docs/frames.md).
inline std::string landmarkTable(const std::vector<MixtureLandmark>& landmarks, const ClassTable& classes) {
  std::string text = "id,class,x,y,z,existence,observations\n";
  for (const MixtureLandmark& landmark : landmarks) {
    text += std::to_string(landmark.id) + "," + classes[landmark.mostLikelyClass()].name;
    for (int i = 0; i < 3; ++i) text += "," + formatFixed(landmark.position.mean_m[i], 4);
    text += "," + formatFixed(landmark.existence_prob, 6) + "," + std::to_string(landmark.observations) + "\n";
  }
  return text;
}

}  // namespace semantic_mht_slam
