#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "semantic_mht_slam/models/detection.h"
#include "semantic_mht_slam/perception/clustering.h"
#include "semantic_mht_slam/perception/extraction_config.h"

namespace semantic_mht_slam {

/// An object of a scan, in the frame of the scan.
struct ExtractedObject {
  Detection detection;  ///< `row` is its place among the objects of the scan
  Eigen::Vector3d box_min_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d box_max_m = Eigen::Vector3d::Zero();
};

/// What an extraction found, and what it left out and why.
struct Extraction {
  std::vector<ExtractedObject> objects;
  std::size_t points = 0;
  std::size_t points_not_finite = 0;
  std::size_t points_out_of_range = 0;
  std::map<std::uint16_t, std::size_t> unknown_labels;  ///< points or pixels by label id that the map lacks
  std::size_t small_clusters = 0;                       ///< removed by the size rule

  Detections detections() const;

  /// "label ids that are not in the class map: 7 (120 points), ..."; empty if every id is known. `unit` is "points" or
  /// "pixels".
  std::string describeUnknownLabels(const std::string& unit) const;
};

/// Measures an object: the centroid is the mean of its points, as in X-View and GOSMatch, the box holds them all, and
///
///     cov = sensor_stddev^2 I + visible_part_ratio^2 S,   S = covariance of the points about the centroid,
///
/// since the part of an object that a view shows moves the mean by a share of the object's spread. The score
/// n / (n + min_points) is 1/2 for the smallest object that counts and tends to 1. `cluster` must not be empty.
ExtractedObject measureObject(const std::vector<Eigen::Vector3f>& points_m, const Cluster& cluster,
                              ClassIndex class_index, const ExtractionConfig& config);

/// Whether a flag is set for more than half of a cluster's points.
bool isMajority(const std::vector<bool>& flags, const Cluster& cluster);

/// The size rule: enough points, and high enough.
bool isLargeEnough(const ExtractedObject& object, const ClusterConfig& config);

}  // namespace semantic_mht_slam
