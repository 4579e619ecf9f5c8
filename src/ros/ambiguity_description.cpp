#include "semantic_mht_slam/ros/ambiguity_description.h"

#include <cmath>
#include <cstdio>

#include "semantic_mht_slam/bags/conversions.h"
#include "semantic_mht_slam/common/text.h"
#include "semantic_mht_slam/ros/landmark_description.h"

namespace semantic_mht_slam {
namespace {

std::string tenthsOfPercent(double probability) {
  return formatFixed(100.0 * probability, 1) + " %";
}

std::string nats(double value) {
  return (value < 0.0 ? "" : "+") + formatFixed(value, 1);
}

LandmarkId nameInMap(const Map& map, LandmarkId landmark) {
  return landmark == kNoLandmark ? kNoLandmark : map.identity().landmarkOf(landmark);
}

DetectionAlternative toMessage(const AssociationAlternative& alternative, const Map& map) {
  DetectionAlternative message;
  message.landmark = nameInMap(map, alternative.landmark);
  message.probability = alternative.probability;
  message.distance = alternative.distance_sigma;
  message.log_expected = alternative.log_expected;
  message.log_place = alternative.log_place;
  message.log_class = alternative.log_class;
  message.observations = static_cast<std::uint32_t>(alternative.observations);
  message.log_count_prior = alternative.log_count_prior;
  return message;
}

AmbiguousDetection toMessage(const UnsureDetection& detection, const Pose& T_map_submap, const Map& map,
                             const ClassTable& classes) {
  AmbiguousDetection message;
  message.stamp = toRosTime(detection.stamp);
  message.row = static_cast<std::uint32_t>(detection.row);
  message.class_id = static_cast<std::uint16_t>(classes[detection.class_index].id);
  const Eigen::Vector3d position_m = T_map_submap * detection.position_m;
  message.position.x = position_m.x();
  message.position.y = position_m.y();
  message.position.z = position_m.z();
  message.landmark = nameInMap(map, detection.landmark);
  message.probability = detection.probability;
  message.moving_prob = detection.moving_prob;
  message.clutter_density = std::exp(detection.log_clutter_density);
  for (const AssociationAlternative& alternative : detection.alternatives) {
    message.alternatives.push_back(toMessage(alternative, map));
  }
  return message;
}

}  // namespace

AmbiguousDetections toAmbiguousDetections(const UnsureDetections& unsure, const Map& map, const ClassTable& classes,
                                          const std::string& map_frame) {
  AmbiguousDetections message;
  message.header.frame_id = map_frame;
  message.header.stamp = toRosTime(map.submaps()[unsure.submap]->end);
  message.submap = static_cast<std::uint32_t>(unsure.submap.index());
  message.detections = static_cast<std::uint32_t>(unsure.detections);
  message.ambiguous = static_cast<std::uint32_t>(unsure.unsure);
  message.below = unsure.below_prob;
  const Pose& T_map_submap = map.T_map_submap(unsure.submap);
  for (const UnsureDetection& detection : unsure.items) {
    message.items.push_back(toMessage(detection, T_map_submap, map, classes));
  }
  return message;
}

std::vector<std::string> ambiguityColumns() {
  return {"detection", "probability", "distance", "place", "class", "expected", "count"};
}

std::vector<std::string> describeDetection(const SemanticMap& map, const AmbiguousDetection& detection) {
  const std::string given =
      detection.landmark == 0 ? "given to none" : "given to " + std::to_string(detection.landmark);
  return {nameOfClass(map, detection.class_id) + " at (" + formatFixed(detection.position.x, 1) + ", " +
              formatFixed(detection.position.y, 1) + ") m, " + given,
          tenthsOfPercent(detection.probability),
          detection.moving_prob >= 0.005 ? "moves: " + tenthsOfPercent(detection.moving_prob) : ""};
}

std::vector<std::string> describeAlternative(const AmbiguousDetection& detection,
                                             const DetectionAlternative& alternative) {
  if (alternative.landmark == 0) {
    char density[32];
    std::snprintf(density, sizeof(density), "%.1e", detection.clutter_density);
    return {std::string("nothing: clutter of ") + density + " a m^3", tenthsOfPercent(alternative.probability)};
  }
  return {"landmark " + std::to_string(alternative.landmark),
          tenthsOfPercent(alternative.probability),
          formatFixed(alternative.distance, 1) + " sigma",
          nats(alternative.log_place),
          nats(alternative.log_class),
          nats(alternative.log_expected),
          std::to_string(alternative.observations) + " (" + nats(alternative.log_count_prior) + ")"};
}

std::string summaryOf(const AmbiguousDetections& message) {
  std::string text = "submap " + std::to_string(message.submap) + ": " + std::to_string(message.ambiguous) + " of " +
                     std::to_string(message.detections) + " detections below " + tenthsOfPercent(message.below);
  if (message.items.size() < message.ambiguous) {
    text += ", the " + std::to_string(message.items.size()) + " least sure";
  }
  return text;
}

}  // namespace semantic_mht_slam
