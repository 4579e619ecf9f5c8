#include "semantic_mht_slam/ros/landmark_description.h"

#include <algorithm>
#include <cmath>

#include "semantic_mht_slam/common/text.h"

namespace semantic_mht_slam {
namespace {

constexpr double kSmallestClassProb = 0.005;  // would be shown as 0 %

std::string percent(double probability) {
  return formatFixed(100.0 * probability, 0) + " %";
}

std::string classesOf(const SemanticMap& map, const Landmark& landmark) {
  std::vector<std::pair<double, std::string>> classes;
  for (std::size_t i = 0; i < std::min(map.classes.size(), landmark.class_probs.size()); ++i) {
    if (landmark.class_probs[i] >= kSmallestClassProb) {
      classes.emplace_back(landmark.class_probs[i], map.classes[i].name);
    }
  }
  std::stable_sort(classes.begin(), classes.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<std::string> texts;
  for (const auto& [probability, name] : classes) texts.push_back(name + " " + percent(probability));
  return "classes: " + joined(texts);
}

std::string historyOf(const Landmark& landmark) {
  std::string text = "seen " + std::to_string(landmark.observations) + " times, ";
  text += landmark.first_submap == landmark.last_submap
              ? "in submap " + std::to_string(landmark.last_submap)
              : "in submaps " + std::to_string(landmark.first_submap) + " to " + std::to_string(landmark.last_submap);
  if (landmark.movable) text += ", standing for " + formatFixed(landmark.seen_standing, 1) + " s";
  if (landmark.merged_ids.empty()) return text;
  std::vector<std::string> ids;
  for (const std::uint64_t id : landmark.merged_ids) ids.push_back(std::to_string(id));
  return text + "; took over the ids " + joined(ids);
}

/// "62 % at (1.0, 2.0, 0.5) m, +-0.3 m": the deviation is that along the longest axis seen from above.
std::string placeOf(const GaussianComponent& component) {
  const double xx = component.covariance[0];
  const double xy = component.covariance[1];
  const double yy = component.covariance[4];
  const double largest_m2 = 0.5 * (xx + yy) + std::hypot(0.5 * (xx - yy), xy);
  return percent(component.weight) + " at (" + formatFixed(component.mean.x, 1) + ", " +
         formatFixed(component.mean.y, 1) + ", " + formatFixed(component.mean.z, 1) + ") m, +-" +
         formatFixed(std::sqrt(std::max(0.0, largest_m2)), 2) + " m";
}

}  // namespace

std::string nameOfClass(const SemanticMap& map, std::uint16_t id) {
  for (const SemanticClass& entry : map.classes) {
    if (entry.id == id) return entry.name;
  }
  return "class " + std::to_string(id);
}

const Landmark* nearestLandmark(const SemanticMap& map, const geometry_msgs::Point& point, double limit_m) {
  const Landmark* nearest = nullptr;
  double nearest_m = limit_m;
  for (const Landmark& landmark : map.landmarks) {
    const double distance_m = std::hypot(landmark.position.x - point.x, landmark.position.y - point.y);
    if (distance_m > nearest_m) continue;
    nearest = &landmark;
    nearest_m = distance_m;
  }
  return nearest;
}

std::vector<std::string> describeLandmark(const SemanticMap& map, const Landmark& landmark) {
  std::vector<std::string> lines;
  lines.push_back(nameOfClass(map, landmark.class_id) + " " + std::to_string(landmark.id) + ", exists with " +
                  percent(landmark.existence_prob) + (landmark.undecided ? ", undecided" : ""));
  lines.push_back(classesOf(map, landmark));
  lines.push_back(historyOf(landmark));
  for (const GaussianComponent& component : landmark.components) lines.push_back(placeOf(component));
  return lines;
}

}  // namespace semantic_mht_slam
