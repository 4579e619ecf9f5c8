#include "semantic_mht_slam/place/histogram_index.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <tuple>

#include <gtest/gtest.h>

#include "place/random_histograms.h"

namespace semantic_mht_slam {
namespace {

double distanceOf(HistogramMetric metric, const ClassHistogram& a, const ClassHistogram& b) {
  return metric == HistogramMetric::kEuclidean ? euclideanDistance(a, b) : jensenShannonDivergence(a, b);
}

std::vector<HistogramMatch> bruteForce(HistogramMetric metric, const std::vector<ClassHistogram>& histograms,
                                       const ClassHistogram& query, std::size_t count, double max_distance,
                                       const HistogramIndex::Filter& passes) {
  std::vector<HistogramMatch> matches;
  for (std::size_t i = 0; i < histograms.size(); ++i) {
    if (isEmpty(histograms[i]) || isEmpty(query) || !passes(i)) continue;
    const double distance = distanceOf(metric, histograms[i], query);
    if (distance <= max_distance) matches.push_back({i, distance});
  }
  std::sort(matches.begin(), matches.end(), [](const HistogramMatch& a, const HistogramMatch& b) {
    return std::tie(a.distance, a.index) < std::tie(b.distance, b.index);
  });
  if (matches.size() > count) matches.resize(count);
  return matches;
}

void expectSame(const std::vector<HistogramMatch>& found, const std::vector<HistogramMatch>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i].distance, expected[i].distance);
    EXPECT_EQ(found[i].index, expected[i].index) << "rank " << i << ", distance " << found[i].distance;
  }
}

class HistogramIndexTest : public testing::TestWithParam<HistogramMetric> {};

TEST_P(HistogramIndexTest, EqualsBruteForceAfterEveryInsertion) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Rng rng(seed);
    const int classes = 1 + static_cast<int>(rng.index(8));
    HistogramIndex index(GetParam(), classes);
    std::vector<ClassHistogram> histograms;
    for (int n = 0; n < 300; ++n) {
      histograms.push_back(randomHistogram(classes, static_cast<int>(rng.index(12)), rng));
      index.insert(histograms.back());
      const ClassHistogram query = randomHistogram(classes, 1 + static_cast<int>(rng.index(12)), rng);
      const auto all = [](std::size_t) { return true; };
      expectSame(index.nearest(query, 5, 10.0), bruteForce(GetParam(), histograms, query, 5, 10.0, all));
    }
  }
}

TEST_P(HistogramIndexTest, EqualsBruteForceWithTiesDuplicatesZerosLimitsAndFilters) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    Rng rng(seed);
    const int classes = 2 + static_cast<int>(rng.index(12));
    const int max_objects = 1 + static_cast<int>(rng.index(seed % 2 == 0 ? 5 : 200));  // few objects: mostly ties
    HistogramIndex index(GetParam(), classes);
    std::vector<ClassHistogram> histograms;
    for (std::uint64_t n = 0, size = 1 + rng.index(3000); n < size; ++n) {
      const bool is_repeated = n > 0 && rng.bernoulli(0.1);
      histograms.push_back(is_repeated ? histograms[rng.index(n)]
                                       : randomHistogram(classes, static_cast<int>(rng.index(max_objects + 1)), rng));
      index.insert(histograms.back());
    }
    for (int i = 0; i < 20; ++i) {
      const ClassHistogram query = i % 2 == 0 ? histograms[rng.index(histograms.size())]
                                              : randomHistogram(classes, static_cast<int>(rng.index(max_objects)), rng);
      const std::size_t count = rng.index(30);
      const double max_distance = rng.uniform(0.0, 0.7);
      const std::size_t end = rng.index(histograms.size() + 1);
      const auto before_end = [end](std::size_t k) { return k < end; };
      expectSame(index.nearest(query, count, max_distance, end),
                 bruteForce(GetParam(), histograms, query, count, max_distance, before_end));
      const auto is_third = [](std::size_t k) { return k % 3 == 0; };
      expectSame(index.nearest(query, count, 10.0, is_third),
                 bruteForce(GetParam(), histograms, query, count, 10.0, is_third));
    }
  }
}

TEST_P(HistogramIndexTest, FindsTheOldestOfManyEqualHistograms) {
  HistogramIndex index(GetParam(), 3);
  Rng rng(1);
  const ClassHistogram histogram = randomHistogram(3, 7, rng);
  for (int i = 0; i < 1000; ++i) index.insert(histogram);
  const auto found = index.nearest(histogram, 4, 0.0);
  ASSERT_EQ(found.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(found[i].index, i);
}

TEST_P(HistogramIndexTest, EmptyHistogramsAreCountedButNeverFoundAndFindNothing) {
  HistogramIndex index(GetParam(), 2);
  Rng rng(1);
  index.insert(ClassHistogram::Zero(2));
  index.insert(randomHistogram(2, 5, rng));
  EXPECT_EQ(index.size(), 2u);
  EXPECT_TRUE(index.nearest(ClassHistogram::Zero(2), 5, 10.0).empty());
  const auto found = index.nearest(randomHistogram(2, 3, rng), 5, 10.0);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].index, 1u);
}

TEST_P(HistogramIndexTest, UnusableHistogramsThrow) {
  HistogramIndex index(GetParam(), 2);
  EXPECT_THROW(index.insert(ClassHistogram::Zero(3)), std::invalid_argument);
  EXPECT_THROW(index.insert(ClassHistogram::Constant(2, 1.0)), std::invalid_argument);
  ClassHistogram histogram = ClassHistogram::Constant(2, 0.5);
  histogram[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(index.nearest(histogram, 1, 1.0), std::invalid_argument);
  EXPECT_THROW(HistogramIndex(GetParam(), 0), std::invalid_argument);
  EXPECT_THROW(HistogramIndex(GetParam(), kMaxClasses + 1), std::invalid_argument);
  EXPECT_EQ(index.size(), 0u);
}

INSTANTIATE_TEST_SUITE_P(Metrics, HistogramIndexTest,
                         testing::Values(HistogramMetric::kJensenShannon, HistogramMetric::kEuclidean));

}  // namespace
}  // namespace semantic_mht_slam
