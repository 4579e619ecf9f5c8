// Times of the histogram index on scenes of 25 objects in 8 classes: inserting all of n histograms, and one search for
// the 10 nearest among n.

#include <vector>

#include <benchmark/benchmark.h>

#include "semantic_mht_slam/place/histogram_index.h"

#include "place/random_histograms.h"

namespace semantic_mht_slam {
namespace {

constexpr int kClasses = 8;
constexpr int kObjects = 25;

std::vector<ClassHistogram> randomHistograms(std::size_t count, std::uint64_t seed) {
  Rng rng(seed);
  std::vector<ClassHistogram> histograms;
  for (std::size_t i = 0; i < count; ++i) histograms.push_back(randomHistogram(kClasses, kObjects, rng));
  return histograms;
}

HistogramIndex makeIndex(HistogramMetric metric, const std::vector<ClassHistogram>& histograms) {
  HistogramIndex index(metric, kClasses);
  for (const ClassHistogram& histogram : histograms) index.insert(histogram);
  return index;
}

void insertAll(benchmark::State& state, HistogramMetric metric) {
  const auto histograms = randomHistograms(static_cast<std::size_t>(state.range(0)), 1);
  for (auto _ : state) benchmark::DoNotOptimize(makeIndex(metric, histograms).size());
  state.counters["us/insert"] =
      benchmark::Counter(static_cast<double>(state.range(0)) * 1e-6,
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void findNearest(benchmark::State& state, HistogramMetric metric) {
  const HistogramIndex index = makeIndex(metric, randomHistograms(static_cast<std::size_t>(state.range(0)), 1));
  const auto queries = randomHistograms(64, 2);
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(index.nearest(queries[i++ % queries.size()], 10, 0.1));
}

void compareAll(benchmark::State& state, HistogramMetric metric) {
  const auto histograms = randomHistograms(static_cast<std::size_t>(state.range(0)), 1);
  const auto queries = randomHistograms(64, 2);
  std::size_t i = 0;
  for (auto _ : state) {
    double sum = 0.0;
    const ClassHistogram& query = queries[i++ % queries.size()];
    for (const ClassHistogram& histogram : histograms) {
      sum += metric == HistogramMetric::kEuclidean ? euclideanDistance(query, histogram)
                                                   : jensenShannonDivergence(query, histogram);
    }
    benchmark::DoNotOptimize(sum);
  }
}

BENCHMARK_CAPTURE(insertAll, divergence, HistogramMetric::kJensenShannon)->RangeMultiplier(10)->Range(100, 100000);
BENCHMARK_CAPTURE(insertAll, euclidean, HistogramMetric::kEuclidean)->RangeMultiplier(10)->Range(100, 100000);
BENCHMARK_CAPTURE(findNearest, divergence, HistogramMetric::kJensenShannon)->RangeMultiplier(10)->Range(100, 100000);
BENCHMARK_CAPTURE(findNearest, euclidean, HistogramMetric::kEuclidean)->RangeMultiplier(10)->Range(100, 100000);
BENCHMARK_CAPTURE(compareAll, divergence, HistogramMetric::kJensenShannon)->RangeMultiplier(10)->Range(100, 100000);
BENCHMARK_CAPTURE(compareAll, euclidean, HistogramMetric::kEuclidean)->RangeMultiplier(10)->Range(100, 100000);

}  // namespace
}  // namespace semantic_mht_slam

BENCHMARK_MAIN();
