#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

#include "semantic_mht_slam/place/class_histogram.h"

namespace semantic_mht_slam {

/// How two class histograms are compared.
enum class HistogramMetric {
  kJensenShannon,  ///< divergence in nats, in [0, ln 2]
  kEuclidean,      ///< in [0, sqrt 2]
};

/// A histogram that was found.
struct HistogramMatch {
  std::size_t index = 0;  ///< how many had been inserted before it
  double distance = 0.0;
};

/// Incremental nearest-neighbour search over class histograms (paper, section III-B): equal to comparing with every
/// one, ties included.
///
/// Newly inserted histograms wait in a small list that is compared one by one. A full list becomes a kd-tree (FLANN's
/// exact KDTreeSingleIndex), and trees of equal size are joined into one of twice the size, so that there are O(log n)
/// trees and a histogram is built into O(log n) of them (the logarithmic method of Bentley and Saxe, 1980).
class HistogramIndex {
 public:
  /// For histograms of `classes` entries. Throws std::invalid_argument unless 1 <= classes <= kMaxClasses.
  HistogramIndex(HistogramMetric metric, int classes);
  ~HistogramIndex();
  HistogramIndex(HistogramIndex&&) noexcept;
  HistogramIndex& operator=(HistogramIndex&&) noexcept;

  /// Adds a histogram; its index is the number of calls before. An empty one is counted but never found.
  /// Throws std::invalid_argument for another number of classes, for entries that are negative or not finite, and for
  /// a sum that is neither 0 nor 1.
  void insert(const ClassHistogram& histogram);

  /// Number of histograms inserted.
  std::size_t size() const;

  /// Says whether a histogram may be found, by its index.
  using Filter = std::function<bool(std::size_t)>;

  /// The at most `count` nearest histograms among those that pass the filter and are at most `max_distance` away,
  /// nearest first, equally near ones by rising index. Nothing for an empty query and for a negative `max_distance`.
  /// Throws std::invalid_argument as `insert` does.
  std::vector<HistogramMatch> nearest(const ClassHistogram& query, std::size_t count, double max_distance,
                                      const Filter& passes) const;

  /// The same among the histograms before index `end`.
  std::vector<HistogramMatch> nearest(const ClassHistogram& query, std::size_t count, double max_distance,
                                      std::size_t end) const;

  /// The same among all.
  std::vector<HistogramMatch> nearest(const ClassHistogram& query, std::size_t count, double max_distance) const;

 private:
  struct Implementation;

  std::unique_ptr<Implementation> implementation_;
};

}  // namespace semantic_mht_slam
