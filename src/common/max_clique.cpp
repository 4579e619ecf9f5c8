#include "semantic_mht_slam/common/max_clique.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>

namespace semantic_mht_slam {
namespace {

class Search {
 public:
  Search(const BitGraph& graph, long max_steps) : graph_(graph), steps_left_(max_steps) {}

  std::vector<int> run() {
    std::vector<int> nodes(graph_.size());
    std::iota(nodes.begin(), nodes.end(), 0);
    std::stable_sort(nodes.begin(), nodes.end(), [this](int a, int b) { return graph_.degree(a) > graph_.degree(b); });
    expand(nodes);
    std::sort(best_.begin(), best_.end());
    return best_;
  }

 private:
  /// Sorts `nodes` by colour and returns the colours (from 1): nodes of one colour are not joined, so a clique among
  /// the first k nodes has at most colour[k - 1] members.
  std::vector<int> colour(std::vector<int>& nodes) const {
    std::vector<std::vector<int>> classes;
    for (const int node : nodes) {
      const auto fits = [this, node](const std::vector<int>& members) {
        return std::none_of(members.begin(), members.end(), [&](int other) { return graph_.joined(node, other); });
      };
      const auto found = std::find_if(classes.begin(), classes.end(), fits);
      if (found == classes.end()) {
        classes.push_back({node});
      } else {
        found->push_back(node);
      }
    }
    std::vector<int> colours;
    nodes.clear();
    for (std::size_t i = 0; i < classes.size(); ++i) {
      nodes.insert(nodes.end(), classes[i].begin(), classes[i].end());
      colours.insert(colours.end(), classes[i].size(), static_cast<int>(i) + 1);
    }
    return colours;
  }

  void expand(std::vector<int> nodes) {
    const std::vector<int> colours = colour(nodes);
    for (int i = static_cast<int>(nodes.size()) - 1; i >= 0; --i) {
      if (current_.size() + colours[i] <= best_.size() || steps_left_-- <= 0) return;
      current_.push_back(nodes[i]);
      std::vector<int> common;
      for (int k = 0; k < i; ++k) {
        if (graph_.joined(nodes[i], nodes[k])) common.push_back(nodes[k]);
      }
      if (current_.size() > best_.size()) best_ = current_;
      if (!common.empty()) expand(std::move(common));
      current_.pop_back();
    }
  }

  const BitGraph& graph_;
  long steps_left_;
  std::vector<int> current_;
  std::vector<int> best_;
};

}  // namespace

BitGraph::BitGraph(int size) : size_(size), rows_(size, std::vector<std::uint64_t>((size + 63) / 64, 0)) {}

void BitGraph::join(int a, int b) {
  if (a < 0 || b < 0 || a >= size_ || b >= size_ || a == b) throw std::invalid_argument("BitGraph: no such pair");
  rows_[a][b / 64] |= std::uint64_t{1} << (b % 64);
  rows_[b][a / 64] |= std::uint64_t{1} << (a % 64);
}

int BitGraph::degree(int node) const {
  int count = 0;
  for (int other = 0; other < size_; ++other) count += joined(node, other) ? 1 : 0;
  return count;
}

std::vector<int> maximumClique(const BitGraph& graph, long max_steps) {
  return Search(graph, max_steps).run();
}

}  // namespace semantic_mht_slam
