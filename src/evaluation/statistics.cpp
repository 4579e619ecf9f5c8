#include "semantic_mht_slam/evaluation/statistics.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>

namespace semantic_mht_slam {
namespace {

constexpr double kUndefined = std::numeric_limits<double>::quiet_NaN();

}  // namespace

double mean(const std::vector<double>& values) {
  if (values.empty()) return kUndefined;
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double rootMeanSquare(const std::vector<double>& values) {
  std::vector<double> squares(values);
  for (double& value : squares) value *= value;
  return std::sqrt(mean(squares));
}

double standardDeviation(const std::vector<double>& values) {
  const double center = mean(values);
  std::vector<double> deviations(values);
  for (double& value : deviations) value -= center;
  return rootMeanSquare(deviations);
}

double median(std::vector<double> values) {
  if (values.empty()) return kUndefined;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

double share(std::int64_t part, std::int64_t whole) {
  return static_cast<double>(part) / static_cast<double>(std::max<std::int64_t>(1, whole));
}

}  // namespace semantic_mht_slam
