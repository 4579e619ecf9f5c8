#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace semantic_mht_slam {

/// log(sum_i exp(x_i)) without overflow; -infinity for an empty list.
inline double logSumExp(const std::vector<double>& values) {
  if (values.empty()) return -std::numeric_limits<double>::infinity();
  const double largest = *std::max_element(values.begin(), values.end());
  if (!std::isfinite(largest)) return largest;
  double sum = 0.0;
  for (const double value : values) sum += std::exp(value - largest);
  return largest + std::log(sum);
}

/// log(exp(a) + exp(b)) without overflow.
inline double logAdd(double a, double b) {
  const double larger = std::max(a, b);
  if (!std::isfinite(larger)) return larger;
  return larger + std::log1p(std::exp(std::min(a, b) - larger));
}

/// log(p / (1 - p)).
inline double logit(double prob) {
  return std::log(prob) - std::log1p(-prob);
}

/// Inverse of `logit`.
inline double logistic(double log_odds) {
  return 1.0 / (1.0 + std::exp(-log_odds));
}

/// log(n!).
inline double logFactorial(int n) {
  return std::lgamma(static_cast<double>(n) + 1.0);
}

}  // namespace semantic_mht_slam
