#include "evaluate_landmark_sightings.h"

#include <algorithm>
#include <optional>

#include "semantic_mht_slam/io/objects_file.h"
#include "semantic_mht_slam/models/usable_detection.h"

#include "program.h"

namespace semantic_mht_slam {
namespace {

/// The landmark that stands nearest to a position in the plane, within `radius_m`.
std::optional<std::size_t> nearestTo(const Eigen::Vector3d& position_m, const std::vector<PointLandmark>& landmarks,
                                     double radius_m) {
  std::optional<std::size_t> nearest;
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    const double distance_m = (landmarks[i].position_m - position_m).head<2>().norm();
    if (distance_m > radius_m) continue;
    radius_m = distance_m;
    nearest = i;
  }
  return nearest;
}

}  // namespace

std::vector<int> framesThatShow(const std::vector<PointLandmark>& landmarks, const std::string& objects_path,
                                const ClassTable& table, const std::vector<std::string>& classes,
                                const std::vector<Pose>& T_truth_sensor, double radius_m) {
  std::vector<int> frames(landmarks.size(), 0);
  const ObjectsFile file = readObjects(objects_path, table, T_truth_sensor.size());
  printNotice("evaluate", file.notice);
  const std::vector<Detections>& objects = file.detections;
  for (std::size_t frame = 0; frame < objects.size(); ++frame) {
    std::vector<char> is_shown(landmarks.size(), 0);
    for (const Detection& object : objects[frame]) {
      if (!isUsable(object)) continue;
      const std::string& name = table[object.class_index].name;
      if (!classes.empty() && std::find(classes.begin(), classes.end(), name) == classes.end()) continue;
      const auto nearest = nearestTo(T_truth_sensor[frame] * object.position_m, landmarks, radius_m);
      if (nearest) is_shown[*nearest] = 1;
    }
    for (std::size_t i = 0; i < frames.size(); ++i) frames[i] += is_shown[i];
  }
  return frames;
}

}  // namespace semantic_mht_slam
