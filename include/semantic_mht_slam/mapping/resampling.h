#pragma once

#include <cstddef>
#include <vector>

#include "semantic_mht_slam/common/random.h"

namespace semantic_mht_slam {

/// Upper bound of the number of samples that KLD sampling needs for k distinct ones (Fox, "Adapting the sample size in
/// particle filters through KLD-sampling", IJRR 2003, eq. 7; the cube is missing in the print of the paper):
/// n = (k - 1) / (2 eps) (1 - 2 / (9 (k - 1)) + sqrt(2 / (9 (k - 1))) z)^3, z the upper 1 - delta normal quantile.
/// 1 for k <= 1. Throws std::invalid_argument unless epsilon > 0 and 0 < delta < 1.
double kldBound(std::size_t distinct, double epsilon, double delta);

/// Quantile of the standard normal distribution. Throws std::invalid_argument unless 0 < prob < 1.
double normalQuantile(double prob);

/// 1 / sum of squared weights; the weights sum to 1.
double effectiveSampleSize(const std::vector<double>& weights);

/// Systematic resampling with a sample size bound by `kldBound` of the distinct elements in such a sample, and by
/// `max_samples`. Returns how often each element was drawn, in the mean in proportion to its weight; one uniform number
/// is taken from `rng`.
std::vector<int> kldResample(const std::vector<double>& weights, double epsilon, double delta, std::size_t max_samples,
                             Rng& rng);

}  // namespace semantic_mht_slam
