#include "semantic_mht_slam/mapping/hypothesis_pruning.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "semantic_mht_slam/common/log_math.h"
#include "semantic_mht_slam/mapping/resampling.h"

namespace semantic_mht_slam {
namespace {

void keepBestThird(const TreeConfig& config, std::vector<MapHypothesis>& leaves) {
  const auto limit = static_cast<std::size_t>(config.max_hypotheses);
  if (leaves.size() > limit) leaves.resize(std::max<std::size_t>(1, limit / 3));
}

void resample(const TreeConfig& config, std::vector<MapHypothesis>& leaves, Rng& rng) {
  const auto limit = static_cast<std::size_t>(config.max_hypotheses);
  std::vector<double> weights;
  for (const MapHypothesis& leaf : leaves) weights.push_back(std::exp(leaf.log_weight));
  const bool is_degenerate = effectiveSampleSize(weights) < config.ess_ratio * static_cast<double>(leaves.size());
  if (!is_degenerate && leaves.size() <= limit) return;
  const std::vector<int> counts = kldResample(weights, config.kld_epsilon, config.kld_delta, limit, rng);
  std::vector<MapHypothesis> drawn;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (counts[i] == 0) continue;
    leaves[i].log_weight = std::log(static_cast<double>(counts[i]));
    drawn.push_back(std::move(leaves[i]));
  }
  leaves = std::move(drawn);
}

}  // namespace

void normalizeAndSort(std::vector<MapHypothesis>& leaves) {
  std::vector<double> log_weights;
  for (const MapHypothesis& leaf : leaves) log_weights.push_back(leaf.log_weight);
  const double log_sum = logSumExp(log_weights);
  for (MapHypothesis& leaf : leaves) leaf.log_weight -= log_sum;
  std::stable_sort(leaves.begin(), leaves.end(),
                   [](const MapHypothesis& a, const MapHypothesis& b) { return a.log_weight > b.log_weight; });
}

double logMinWeight(const MapperConfig& config) {
  const bool has_limit = config.estimator != Estimator::kMhm;
  return has_limit ? std::log(config.tree.min_weight) : -std::numeric_limits<double>::infinity();
}

void pruneHypotheses(const MapperConfig& config, std::vector<MapHypothesis>& leaves, Rng& rng) {
  if (config.estimator == Estimator::kMhm) {
    keepBestThird(config.tree, leaves);
  } else {
    const double log_min = logMinWeight(config);
    while (leaves.size() > 1 && leaves.back().log_weight < log_min) leaves.pop_back();
    normalizeAndSort(leaves);
    resample(config.tree, leaves, rng);
  }
  normalizeAndSort(leaves);
}

}  // namespace semantic_mht_slam
