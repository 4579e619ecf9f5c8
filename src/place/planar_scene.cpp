#include "semantic_mht_slam/place/planar_scene.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <tuple>

#include "semantic_mht_slam/common/gaussian.h"

namespace semantic_mht_slam {
namespace {

void check(const SceneObject& object, std::size_t index, const ClassTable& classes) {
  const std::string name = "object " + std::to_string(index) + " of a scene ";
  if (object.class_index < 0 || object.class_index >= classes.size()) {
    throw std::invalid_argument(name + "has an unknown class");
  }
  if (!object.position_m.allFinite()) throw std::invalid_argument(name + "has no finite position");
  if (!isCovariance(object.cov_m2)) {
    throw std::invalid_argument(name + "has a covariance that is not positive definite");
  }
}

PlanarObject makeObject(const SceneObject& object, int index, const ClassInfo& info, double noise_floor_m) {
  PlanarObject result;
  result.position_m = object.position_m.head<2>();
  result.height_m = object.position_m.z();
  double extra_m2 = noise_floor_m * noise_floor_m;
  if (info.transition == Transition::kGaussian) {
    extra_m2 += 0.5 * info.transition_stddev_m * info.transition_stddev_m;  // the other half is in the other scene
  }
  result.cov_m2 = object.cov_m2 + extra_m2 * Eigen::Matrix3d::Identity();
  result.variance_m2 = 0.5 * (result.cov_m2(0, 0) + result.cov_m2(1, 1));
  if (object.landmark != kNoLandmark) result.map_cov_m2 = object.cov_m2;
  result.class_index = object.class_index;
  result.landmark = object.landmark;
  result.index = index;
  return result;
}

double densityAround(const PlanarScene& scene, const PlanarObject& object) {
  const auto begin = scene.objects.begin() + scene.class_begin[object.class_index];
  const auto end = scene.objects.begin() + scene.class_begin[object.class_index + 1];
  const auto neighbours = std::count_if(begin, end, [&](const PlanarObject& other) {
    return (other.position_m - object.position_m).squaredNorm() < kDensityRadius_m * kDensityRadius_m;
  });
  return static_cast<double>(neighbours) / (M_PI * kDensityRadius_m * kDensityRadius_m);
}

}  // namespace

PlanarScene makePlanarScene(const Scene& scene, const ClassTable& classes, double noise_floor_m) {
  PlanarScene result;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const SceneObject& object = scene.objects[i];
    check(object, i, classes);
    result.objects.push_back(makeObject(object, static_cast<int>(i), classes[object.class_index], noise_floor_m));
  }
  const auto key = [](const PlanarObject& o) {
    return std::make_tuple(o.class_index, o.position_m.x(), o.position_m.y(), o.height_m, o.variance_m2, o.index);
  };
  std::sort(result.objects.begin(), result.objects.end(),
            [&](const PlanarObject& a, const PlanarObject& b) { return key(a) < key(b); });
  result.class_begin.assign(classes.size() + 1, 0);
  for (const PlanarObject& object : result.objects) ++result.class_begin[object.class_index + 1];
  for (int c = 0; c < classes.size(); ++c) result.class_begin[c + 1] += result.class_begin[c];
  for (const PlanarObject& object : result.objects) result.centre_m += object.position_m / result.size();
  for (PlanarObject& object : result.objects) object.density_per_m2 = densityAround(result, object);
  return result;
}

}  // namespace semantic_mht_slam
