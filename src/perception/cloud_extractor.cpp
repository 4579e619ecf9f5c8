#include "semantic_mht_slam/perception/cloud_extractor.h"

#include <algorithm>
#include <iterator>
#include <stdexcept>

#include "semantic_mht_slam/perception/vertical_structure.h"

namespace semantic_mht_slam {
namespace {

struct ClassPoints {
  std::vector<Eigen::Vector3f> points_m;
  std::vector<bool> is_moving;
};

void requireMatching(const LabelledCloud& cloud) {
  if (cloud.points_m.size() != cloud.labels.size()) {
    throw std::invalid_argument("extractObjects: " + std::to_string(cloud.points_m.size()) + " points and " +
                                std::to_string(cloud.labels.size()) + " labels");
  }
}

/// Sorts the usable points by class and counts the others.
std::vector<ClassPoints> sortByClass(const LabelledCloud& cloud, const LabelMap& labels, const ExtractionConfig& config,
                                     Extraction& extraction) {
  std::vector<ClassPoints> points(config.classes.size());
  std::vector<std::size_t> unknown(LabelMap::kMaxId + 1, 0);
  const auto min_square = static_cast<float>(config.min_range_m * config.min_range_m);
  const auto max_square = static_cast<float>(config.max_range_m * config.max_range_m);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const ClassIndex class_index = labels.classOf(cloud.labels[i]);
    if (class_index == LabelMap::kUnknown) ++unknown[cloud.labels[i]];
    const Eigen::Vector3f& point = cloud.points_m[i];
    const float square = point.squaredNorm();
    if (!point.allFinite()) {
      ++extraction.points_not_finite;
    } else if (!(square >= min_square && square <= max_square)) {
      ++extraction.points_out_of_range;
    } else if (class_index >= 0) {
      ClassPoints& same = points.at(static_cast<std::size_t>(class_index));
      same.points_m.push_back(point);
      same.is_moving.push_back(labels.isMoving(cloud.labels[i]));
    }
  }
  for (std::size_t id = 0; id < unknown.size(); ++id) {
    if (unknown[id] > 0) extraction.unknown_labels[static_cast<std::uint16_t>(id)] = unknown[id];
  }
  return points;
}

}  // namespace

std::vector<Cluster> clustersOf(const std::vector<Eigen::Vector3f>& points_m, const ClusterConfig& rule,
                                const VerticalConfig& vertical) {
  std::vector<Cluster> clusters = euclideanClusters(points_m, rule.tolerance_m, rule.voxel_m);
  if (!rule.is_vertical) return clusters;
  std::vector<Cluster> split;
  for (const Cluster& cluster : clusters) {
    std::vector<Cluster> parts = splitByAxes(points_m, cluster, vertical);
    std::move(parts.begin(), parts.end(), std::back_inserter(split));
  }
  return mergeByAxes(points_m, split, vertical);
}

Extraction extractObjects(const LabelledCloud& cloud, const LabelMap& labels, const ExtractionConfig& config) {
  requireMatching(cloud);
  Extraction extraction;
  extraction.points = cloud.size();
  const std::vector<ClassPoints> classes = sortByClass(cloud, labels, config, extraction);
  for (std::size_t c = 0; c < classes.size(); ++c) {
    const ClassPoints& points = classes[c];
    for (const Cluster& cluster : clustersOf(points.points_m, config.classes[c], config.vertical)) {
      ExtractedObject object = measureObject(points.points_m, cluster, static_cast<ClassIndex>(c), config);
      if (!isLargeEnough(object, config.classes[c])) {
        ++extraction.small_clusters;
        continue;
      }
      object.detection.is_moving = isMajority(points.is_moving, cluster);
      object.detection.row = static_cast<int>(extraction.objects.size());
      extraction.objects.push_back(object);
    }
  }
  return extraction;
}

}  // namespace semantic_mht_slam
