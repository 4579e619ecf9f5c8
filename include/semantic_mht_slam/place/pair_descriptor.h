#pragma once

#include <Eigen/Core>

#include "semantic_mht_slam/common/config.h"
#include "semantic_mht_slam/map/scene.h"
#include "semantic_mht_slam/models/class_table.h"

namespace semantic_mht_slam {

/// Parameters of `describePairs`.
struct PairDescriptorConfig {
  double bin_m = 1.0;
  double max_distance_m = 50.0;
  double movable_weight = 0.6;
};

void describe(PairDescriptorConfig& config, Fields& fields);

/// What a place looks like whatever the pose from which it is seen: square roots of the shares of the distances between
/// its objects, a histogram a pair of classes. Unit length, or zero for a scene with fewer than two objects.
using PairDescriptor = Eigen::VectorXf;

/// Descriptor of a scene: each pair of objects is spread over the bins by the standard deviation of its distance, to
/// which the covariances, the Gaussian transition of the classes and `noise_floor_m` of each object contribute. A pair
/// counts less for each end that may drive away. Does not depend on the order of the objects.
/// Throws std::invalid_argument for a class that the table lacks.
PairDescriptor describePairs(const Scene& scene, const ClassTable& classes, double noise_floor_m,
                             const PairDescriptorConfig& config);

/// Bhattacharyya coefficient in [0, 1] of two descriptors of one configuration; zero when one is empty.
double descriptorSimilarity(const PairDescriptor& a, const PairDescriptor& b);

}  // namespace semantic_mht_slam
