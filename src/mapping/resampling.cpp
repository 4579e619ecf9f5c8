#include "semantic_mht_slam/mapping/resampling.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace semantic_mht_slam {
namespace {

/// How often each element is drawn at the positions (start + i) / samples of the cumulative weights.
std::vector<int> systematicSample(const std::vector<double>& weights, double start, std::size_t samples) {
  std::vector<int> counts(weights.size(), 0);
  const double step = 1.0 / static_cast<double>(samples);
  double cumulative = weights[0];
  std::size_t element = 0;
  for (std::size_t i = 0; i < samples; ++i) {
    const double position = (start + static_cast<double>(i)) * step;
    while (position >= cumulative && element + 1 < weights.size()) cumulative += weights[++element];
    ++counts[element];
  }
  return counts;
}

/// Least size, from as many as there are elements on, that meets the bound of the distinct elements that it holds: the
/// bound of the single element that one sample would draw says nothing. The elements are counted at the middle of the
/// steps: a size that depended on the draw itself would prefer draws that need few samples, which is a bias.
std::size_t sampleSize(const std::vector<double>& weights, double epsilon, double delta, std::size_t max_samples) {
  std::size_t samples = std::min(max_samples, weights.size());
  while (true) {
    const std::vector<int> counts = systematicSample(weights, 0.5, samples);
    const auto distinct = counts.size() - static_cast<std::size_t>(std::count(counts.begin(), counts.end(), 0));
    const double bound = std::min(kldBound(distinct, epsilon, delta), static_cast<double>(max_samples));
    if (static_cast<double>(samples) >= bound) return samples;
    samples = std::min(max_samples, std::max(samples + 1, static_cast<std::size_t>(std::ceil(bound))));
  }
}

}  // namespace

double normalQuantile(double prob) {
  if (!(prob > 0.0 && prob < 1.0)) throw std::invalid_argument("normalQuantile: probability outside (0, 1)");
  double low = -40.0;
  double high = 40.0;
  for (int i = 0; i < 200; ++i) {
    const double x = 0.5 * (low + high);
    (0.5 * std::erfc(-x / std::sqrt(2.0)) < prob ? low : high) = x;
  }
  return 0.5 * (low + high);
}

double kldBound(std::size_t distinct, double epsilon, double delta) {
  if (!(epsilon > 0.0)) throw std::invalid_argument("kldBound: epsilon must be positive");
  const double z = normalQuantile(1.0 - delta);
  if (distinct <= 1) return 1.0;
  const double k = static_cast<double>(distinct - 1);
  const double root = 1.0 - 2.0 / (9.0 * k) + std::sqrt(2.0 / (9.0 * k)) * z;
  return k / (2.0 * epsilon) * root * root * root;
}

double effectiveSampleSize(const std::vector<double>& weights) {
  double squares = 0.0;
  for (const double weight : weights) squares += weight * weight;
  return squares > 0.0 ? 1.0 / squares : 0.0;
}

std::vector<int> kldResample(const std::vector<double>& weights, double epsilon, double delta, std::size_t max_samples,
                             Rng& rng) {
  if (weights.empty() || max_samples == 0) return std::vector<int>(weights.size(), 0);
  return systematicSample(weights, rng.uniform(), sampleSize(weights, epsilon, delta, max_samples));
}

}  // namespace semantic_mht_slam
