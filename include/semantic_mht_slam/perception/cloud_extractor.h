#pragma once

#include "semantic_mht_slam/models/label_map.h"
#include "semantic_mht_slam/models/labelled_cloud.h"
#include "semantic_mht_slam/perception/extracted_object.h"
#include "semantic_mht_slam/perception/extraction_config.h"

namespace semantic_mht_slam {

/// Objects of a labelled cloud, class by class in the order of the table: Euclidean clusters, vertical classes split
/// and merged by their axes, small clusters removed. An object moves if more than half of its points have a moving
/// label. Points that are not finite or out of range and labels that the map lacks are left out and counted. Throws
/// std::invalid_argument if the cloud has not one label a point, std::out_of_range if the map names a class that the
/// configuration lacks.
Extraction extractObjects(const LabelledCloud& cloud, const LabelMap& labels, const ExtractionConfig& config);

/// Clusters of one class's points: Euclidean, and for vertical classes split and merged by their axes.
std::vector<Cluster> clustersOf(const std::vector<Eigen::Vector3f>& points_m, const ClusterConfig& rule,
                                const VerticalConfig& vertical);

}  // namespace semantic_mht_slam
