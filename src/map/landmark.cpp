#include "semantic_mht_slam/map/landmark.h"

#include <algorithm>
#include <stdexcept>

namespace semantic_mht_slam {

void LandmarkSize::add(const LandmarkSize& other) {
  if (other.detections == 0) return;
  detections += other.detections;
  mean_m += (other.mean_m - mean_m) * other.detections / detections;
}

ClassIndex MixtureLandmark::mostLikelyClass() const {
  Eigen::Index best = 0;
  class_probs.maxCoeff(&best);
  return static_cast<ClassIndex>(best);
}

std::vector<MixtureLandmark>::const_iterator placeOf(LandmarkId id, const std::vector<MixtureLandmark>& landmarks) {
  return std::lower_bound(landmarks.begin(), landmarks.end(), id,
                          [](const MixtureLandmark& landmark, LandmarkId i) { return landmark.id < i; });
}

const MixtureLandmark* findLandmark(LandmarkId id, const std::vector<MixtureLandmark>& landmarks) {
  const auto place = placeOf(id, landmarks);
  return place == landmarks.end() || place->id != id ? nullptr : &*place;
}

MixtureLandmark transformed(const Pose& T_a_b, const MixtureLandmark& landmark) {
  const Eigen::Matrix3d R = T_a_b.rotation.toRotationMatrix();
  const auto move = [&](Gaussian3& gaussian) {
    gaussian.mean_m = T_a_b * gaussian.mean_m;
    const Eigen::Matrix3d cov = R * gaussian.cov_m2 * R.transpose();
    gaussian.cov_m2 = 0.5 * (cov + cov.transpose());
  };
  MixtureLandmark result = landmark;
  move(result.position);
  for (MixtureComponent& component : result.components) move(component.position);
  return result;
}

Gaussian3 moments(const std::vector<MixtureComponent>& components) {
  if (components.empty()) throw std::invalid_argument("a mixture without components");
  double weight = 0.0;
  Gaussian3 result{Eigen::Vector3d::Zero(), Eigen::Matrix3d::Zero()};
  for (const MixtureComponent& component : components) {
    weight += component.weight;
    result.mean_m += component.weight * component.position.mean_m;
  }
  result.mean_m /= weight;
  for (const MixtureComponent& component : components) {
    const Eigen::Vector3d d = component.position.mean_m - result.mean_m;
    result.cov_m2 += component.weight / weight * (component.position.cov_m2 + d * d.transpose());
  }
  return result;
}

}  // namespace semantic_mht_slam
