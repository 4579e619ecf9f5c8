#include "semantic_mht_slam/place/pair_descriptor.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <tuple>
#include <vector>

#include "semantic_mht_slam/common/saturated.h"

namespace semantic_mht_slam {
namespace {

constexpr double kReachSigmas = 2.0;

/// Adds a distance to its histogram, as a triangle as wide as the distance is uncertain.
void spread(double distance_m, double stddev_m, double weight, double bin_m, Eigen::Ref<Eigen::VectorXd> bins) {
  const double reach_m = std::max(bin_m, kReachSigmas * stddev_m);
  const int bin_count = static_cast<int>(bins.size());
  const int first = std::max(0, saturatedInt(std::ceil((distance_m - reach_m) / bin_m - 0.5)));
  const int last = std::min(bin_count - 1, saturatedInt(std::floor((distance_m + reach_m) / bin_m - 0.5)));
  double total = 0.0;
  const auto height = [&](int bin) {
    return std::max(0.0, 1.0 - std::abs((bin + 0.5) * bin_m - distance_m) / reach_m);
  };
  for (int bin = first; bin <= last; ++bin) total += height(bin);
  if (total <= 0.0) return;
  for (int bin = first; bin <= last; ++bin) bins(bin) += weight * height(bin) / total;
}

/// An object seen from above.
struct PlanarObject {
  ClassIndex class_index = 0;
  Eigen::Vector2d position_m;
  double variance_m2 = 0.0;  ///< of each coordinate, mean of both

  bool operator<(const PlanarObject& other) const {
    return std::make_tuple(class_index, position_m.x(), position_m.y(), variance_m2) <
           std::make_tuple(other.class_index, other.position_m.x(), other.position_m.y(), other.variance_m2);
  }
};

/// In an order that depends on values alone, by class.
std::vector<PlanarObject> planarObjects(const Scene& scene, const ClassTable& classes, double noise_floor_m) {
  std::vector<PlanarObject> result;
  for (const SceneObject& object : scene.objects) {
    if (object.class_index < 0 || object.class_index >= classes.size()) {
      throw std::invalid_argument("describePairs: an object has an unknown class");
    }
    const ClassInfo& info = classes[object.class_index];
    double variance_m2 = noise_floor_m * noise_floor_m + 0.5 * (object.cov_m2(0, 0) + object.cov_m2(1, 1));
    if (info.transition == Transition::kGaussian) {
      variance_m2 += 0.5 * info.transition_stddev_m * info.transition_stddev_m;  // the other half is the other scene's
    }
    result.push_back({object.class_index, object.position_m.head<2>(), variance_m2});
  }
  std::sort(result.begin(), result.end());
  return result;
}

}  // namespace

void describe(PairDescriptorConfig& config, Fields& fields) {
  fields.add("bin", config.bin_m, "m", {0.1, 20.0}, "Bin of the distances between two objects.");
  fields.add("max_distance", config.max_distance_m, "m", {1.0, 500.0}, "Pairs further apart are left out.");
  fields.add("movable_weight", config.movable_weight, "", {0.0, 1.0},
             "What a pair counts for each end that may drive away.");
}

PairDescriptor describePairs(const Scene& scene, const ClassTable& classes, double noise_floor_m,
                             const PairDescriptorConfig& config) {
  const std::vector<PlanarObject> objects = planarObjects(scene, classes, noise_floor_m);
  const int bins = saturatedInt(std::ceil(config.max_distance_m / config.bin_m));
  const int count = classes.size();
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(count) * (count + 1) / 2 * bins);
  for (std::size_t i = 0; i < objects.size(); ++i) {
    for (std::size_t k = i + 1; k < objects.size(); ++k) {
      const PlanarObject& a = objects[i];
      const PlanarObject& b = objects[k];
      const double distance_m = (a.position_m - b.position_m).norm();
      if (distance_m >= config.max_distance_m) continue;
      const double weight = (classes[a.class_index].is_static ? 1.0 : config.movable_weight) *
                            (classes[b.class_index].is_static ? 1.0 : config.movable_weight);
      const Eigen::Index pair = static_cast<Eigen::Index>(b.class_index) * (b.class_index + 1) / 2 + a.class_index;
      spread(distance_m, std::sqrt(a.variance_m2 + b.variance_m2), weight, config.bin_m,
             sums.segment(pair * bins, bins));
    }
  }
  const double total = sums.sum();
  if (total <= 0.0) return PairDescriptor::Zero(sums.size());
  return (sums / total).cwiseSqrt().cast<float>();
}

double descriptorSimilarity(const PairDescriptor& a, const PairDescriptor& b) {
  return std::min(1.0, static_cast<double>(a.dot(b)));
}

}  // namespace semantic_mht_slam
