#pragma once

#include <Eigen/Core>

#include "semantic_mht_slam/map/scene.h"
#include "semantic_mht_slam/place/covisibility.h"

namespace semantic_mht_slam {

/// Topology of a scene as a Laplacian over the classes of the table, L = D - A (paper, section III-B); `classes` rows
/// and columns, symmetric.
///
/// A sums the weights of the pairs of objects between two classes, each pair once; D holds the degrees, to which a pair
/// adds at both of its ends. Pairs within a class therefore stay in the diagonal instead of cancelling out. A pair
/// weighs as much as in the covisibility graph if both objects are landmarks which it saw together, else the distance
/// kernel alone. It depends on distances only, hence neither on where the scene is seen from nor in which direction.
/// Throws std::invalid_argument for a class outside the table.
Eigen::MatrixXd classLaplacian(const Scene& scene, int classes, const CovisibilityGraph& graph,
                               const CovisibilityConfig& config);

/// The same from distances alone, for scenes without landmarks.
Eigen::MatrixXd classLaplacian(const Scene& scene, int classes, const CovisibilityConfig& config);

/// Normalised cross-correlation S_ncc of two Laplacians of equal size: the correlation of their entries in [-1, 1],
/// over the classes that occur in one of the two (a row of zeros in both says nothing and would raise every score). 0
/// if one of them does not vary, as that of an empty scene: no evidence. Throws std::invalid_argument for different
/// sizes.
double laplacianCorrelation(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

}  // namespace semantic_mht_slam
