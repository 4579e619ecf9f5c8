#include "semantic_mht_slam/place/submap_features.h"

#include <cmath>
#include <stdexcept>

namespace semantic_mht_slam {

std::array<double, 3> toArray(const SubmapFeatures& features) {
  return {features.entropy, features.tf_idf, static_cast<double>(features.landmarks)};
}

std::optional<double> mixtureEntropy(const std::vector<MixtureLandmark>& landmarks) {
  std::vector<MixtureComponent> components;
  double sum = 0.0;
  for (const MixtureLandmark& landmark : landmarks) {
    components.push_back({landmark.existence_prob, landmark.position});
    sum += landmark.existence_prob;
  }
  if (!(sum > 0.0)) return std::nullopt;
  for (MixtureComponent& component : components) component.weight /= sum;
  const double det = moments(components).cov_m2.determinant();
  if (!(det > 0.0) || !std::isfinite(det)) return std::nullopt;
  return 0.5 * (3.0 * std::log(2.0 * M_PI * M_E) + std::log(det));
}

SubmapFeatureExtractor::SubmapFeatureExtractor(int classes) : classes_(classes) {
  if (classes < 1 || classes > kMaxClasses) throw std::invalid_argument("features without or with too many classes");
  submaps_with_class_.assign(classes, 0);
}

double SubmapFeatureExtractor::tfIdf(const ClassHistogram& histogram) const {
  double score = 0.0;
  for (int c = 0; c < classes_; ++c) {
    if (histogram[c] == 0.0) continue;
    score += histogram[c] * std::log(static_cast<double>(submaps_) / submaps_with_class_[c]);
  }
  return score;
}

std::optional<SubmapFeatures> SubmapFeatureExtractor::add(const Submap& submap) {
  std::vector<MixtureLandmark> landmarks;
  for (const MixtureLandmark& landmark : submap.landmarks) {
    if (landmark.existence_prob >= kMinExistenceProb) landmarks.push_back(landmark);
  }
  const ClassHistogram histogram = classHistogram(landmarks, classes_);
  ++submaps_;
  for (int c = 0; c < classes_; ++c) submaps_with_class_[c] += histogram[c] > 0.0 ? 1 : 0;
  const auto entropy = mixtureEntropy(landmarks);
  if (!entropy) return std::nullopt;
  return SubmapFeatures{*entropy, tfIdf(histogram), static_cast<int>(landmarks.size())};
}

}  // namespace semantic_mht_slam
