#pragma once

#include <cstdint>
#include <vector>

namespace semantic_mht_slam {

/// Undirected graph over 0 .. size-1 as rows of bits.
class BitGraph {
 public:
  explicit BitGraph(int size);

  int size() const { return size_; }

  /// Joins two different nodes. Throws std::invalid_argument for a node outside the graph or joined to itself.
  void join(int a, int b);

  bool joined(int a, int b) const { return (rows_[a][b / 64] >> (b % 64)) & 1U; }
  int degree(int node) const;

 private:
  int size_;
  std::vector<std::vector<std::uint64_t>> rows_;
};

/// Largest set of nodes that are all joined to each other, ascending (branch and bound with a greedy colouring as
/// bound, Tomita and Seki, An efficient branch-and-bound algorithm for finding a maximum clique, 2003). After
/// `max_steps` branches the largest one found so far is returned, so that no input can stall the caller; the answer
/// depends on the graph alone.
std::vector<int> maximumClique(const BitGraph& graph, long max_steps = 5000);

}  // namespace semantic_mht_slam
