#pragma once

#include <vector>

#include <Eigen/Core>

#include "semantic_mht_slam/perception/clustering.h"
#include "semantic_mht_slam/perception/extraction_config.h"

namespace semantic_mht_slam {

/// Splits a cluster of upright things that touch, such as two poles side by side. An axis is a group of adjoining
/// vertical columns that hold points at nearly every height of the cluster, which branches and boards do not; with two
/// or more axes that are at least `split_distance_m` apart each point goes to the nearest. One axis or none leaves the
/// cluster as it is. z points up.
std::vector<Cluster> splitByAxes(const std::vector<Eigen::Vector3f>& points_m, const Cluster& cluster,
                                 const VerticalConfig& config);

/// Merges clusters that lie above each other: pieces of one pole that something in front, or another class on it, has
/// cut. Chains of pieces merge into one. z points up.
std::vector<Cluster> mergeByAxes(const std::vector<Eigen::Vector3f>& points_m, const std::vector<Cluster>& clusters,
                                 const VerticalConfig& config);

}  // namespace semantic_mht_slam
