#include "semantic_mht_slam/place/class_histogram.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace semantic_mht_slam {
namespace {

ClassHistogram noCounts(int classes) {
  if (classes < 0 || classes > kMaxClasses) {
    throw std::invalid_argument("a histogram of " + std::to_string(classes) + " classes");
  }
  return ClassHistogram::Zero(classes);
}

void count(ClassIndex class_index, ClassHistogram& counts) {
  if (class_index < 0 || class_index >= counts.size()) {
    throw std::invalid_argument("class " + std::to_string(class_index) + " is not in the table");
  }
  counts[class_index] += 1.0;
}

ClassHistogram normalized(const ClassHistogram& counts) {
  const double sum = counts.sum();
  if (sum == 0.0) return counts;
  return counts / sum;
}

void requireSameSize(const ClassHistogram& a, const ClassHistogram& b) {
  if (a.size() != b.size()) throw std::invalid_argument("histograms of different class tables");
}

}  // namespace

ClassHistogram classHistogram(const Scene& scene, int classes) {
  ClassHistogram counts = noCounts(classes);
  for (const SceneObject& object : scene.objects) count(object.class_index, counts);
  return normalized(counts);
}

ClassHistogram classHistogram(const std::vector<MixtureLandmark>& landmarks, int classes) {
  ClassHistogram counts = noCounts(classes);
  for (const MixtureLandmark& landmark : landmarks) count(landmark.mostLikelyClass(), counts);
  return normalized(counts);
}

bool isEmpty(const ClassHistogram& histogram) {
  return (histogram == 0.0).all();
}

double divergenceTerm(double a, double b) {
  const double sum = a + b;
  if (sum <= 0.0) return 0.0;
  // ln(a / m) = log1p((a - b) / (a + b)) keeps its digits where a and b are nearly equal.
  const double contrast = (a - b) / sum;
  double term = 0.0;
  if (a > 0.0) term += a * std::log1p(contrast);
  if (b > 0.0) term += b * std::log1p(-contrast);
  return std::max(0.0, 0.5 * term);
}

double jensenShannonDivergence(const ClassHistogram& a, const ClassHistogram& b) {
  requireSameSize(a, b);
  if (isEmpty(a) || isEmpty(b)) return kMaxDivergence;
  double sum = 0.0;
  for (Eigen::Index i = 0; i < a.size(); ++i) sum += divergenceTerm(a[i], b[i]);
  return std::min(sum, kMaxDivergence);
}

double euclideanDistance(const ClassHistogram& a, const ClassHistogram& b) {
  requireSameSize(a, b);
  if (isEmpty(a) || isEmpty(b)) return std::sqrt(2.0);
  double sum = 0.0;
  for (Eigen::Index i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum);
}

}  // namespace semantic_mht_slam
