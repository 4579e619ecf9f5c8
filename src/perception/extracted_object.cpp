#include "semantic_mht_slam/perception/extracted_object.h"

#include <algorithm>

namespace semantic_mht_slam {
namespace {

constexpr std::size_t kMostNamedLabels = 8;

}  // namespace

Detections Extraction::detections() const {
  Detections result;
  result.reserve(objects.size());
  for (const ExtractedObject& object : objects) result.push_back(object.detection);
  return result;
}

std::string Extraction::describeUnknownLabels(const std::string& unit) const {
  if (unknown_labels.empty()) return "";
  std::string text = "label ids that are not in the class map: ";
  std::size_t named = 0;
  for (const auto& [id, count] : unknown_labels) {
    if (named == kMostNamedLabels) return text + " and " + std::to_string(unknown_labels.size() - named) + " more";
    text += (named++ > 0 ? ", " : "") + std::to_string(id) + " (" + std::to_string(count) + " " + unit + ")";
  }
  return text;
}

ExtractedObject measureObject(const std::vector<Eigen::Vector3f>& points_m, const Cluster& cluster,
                              ClassIndex class_index, const ExtractionConfig& config) {
  ExtractedObject object;
  object.box_min_m = points_m[static_cast<std::size_t>(cluster.front())].cast<double>();
  object.box_max_m = object.box_min_m;
  const Eigen::Vector3d origin = object.box_min_m;  // keeps the sums small
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (const int i : cluster) {
    const Eigen::Vector3d point = points_m[static_cast<std::size_t>(i)].cast<double>();
    const Eigen::Vector3d offset = point - origin;
    sum += offset;
    squares += offset * offset.transpose();
    object.box_min_m = object.box_min_m.cwiseMin(point);
    object.box_max_m = object.box_max_m.cwiseMax(point);
  }
  const auto n = static_cast<double>(cluster.size());
  const Eigen::Vector3d mean = sum / n;
  const Eigen::Matrix3d scatter = squares / n - mean * mean.transpose();
  const ClusterConfig& rule = config.classes.at(static_cast<std::size_t>(class_index));
  Detection& detection = object.detection;
  detection.class_index = class_index;
  detection.position_m = origin + mean;
  detection.cov_m2 = config.visible_part_ratio * config.visible_part_ratio * scatter +
                     config.sensor_stddev_m * config.sensor_stddev_m * Eigen::Matrix3d::Identity();
  detection.size_m = object.box_max_m - object.box_min_m;
  detection.points = static_cast<int>(cluster.size());
  detection.score = n / (n + static_cast<double>(rule.min_points));
  return object;
}

bool isMajority(const std::vector<bool>& flags, const Cluster& cluster) {
  const auto set =
      std::count_if(cluster.begin(), cluster.end(), [&](int i) -> bool { return flags[static_cast<std::size_t>(i)]; });
  return 2 * static_cast<std::size_t>(set) > cluster.size();
}

bool isLargeEnough(const ExtractedObject& object, const ClusterConfig& config) {
  return *object.detection.points >= config.min_points && object.detection.size_m->z() >= config.min_height_m;
}

}  // namespace semantic_mht_slam
