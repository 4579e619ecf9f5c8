#include "semantic_mht_slam/common/max_clique.h"

#include <stdexcept>

#include <gtest/gtest.h>

#include "semantic_mht_slam/common/random.h"

namespace semantic_mht_slam {
namespace {

bool isClique(const BitGraph& graph, const std::vector<int>& nodes) {
  for (std::size_t a = 0; a < nodes.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      if (!graph.joined(nodes[a], nodes[b])) return false;
    }
  }
  return true;
}

std::size_t bruteForceSize(const BitGraph& graph) {
  std::size_t best = 0;
  for (int set = 0; set < (1 << graph.size()); ++set) {
    std::vector<int> nodes;
    for (int i = 0; i < graph.size(); ++i) {
      if ((set >> i) & 1) nodes.push_back(i);
    }
    if (nodes.size() > best && isClique(graph, nodes)) best = nodes.size();
  }
  return best;
}

TEST(MaxCliqueTest, EqualsBruteForceOnRandomGraphs) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    Rng rng(seed);
    BitGraph graph(static_cast<int>(1 + rng.index(12)));
    const double density = rng.uniform();
    for (int a = 0; a < graph.size(); ++a) {
      for (int b = 0; b < a; ++b) {
        if (rng.bernoulli(density)) graph.join(a, b);
      }
    }
    const std::vector<int> clique = maximumClique(graph);
    EXPECT_TRUE(isClique(graph, clique));
    EXPECT_EQ(clique.size(), bruteForceSize(graph)) << "seed " << seed;
  }
}

TEST(MaxCliqueTest, FindsAPlantedCliqueAmongHundredsOfNodesWithinItsBudget) {
  Rng rng(5);
  BitGraph graph(400);
  for (int a = 0; a < graph.size(); ++a) {
    for (int b = 0; b < a; ++b) {
      const bool is_planted = a % 5 == 0 && b % 5 == 0;
      if (is_planted || rng.bernoulli(0.2)) graph.join(a, b);
    }
  }
  EXPECT_EQ(maximumClique(graph).size(), 80u);
}

TEST(MaxCliqueTest, EmptyGraphHasAnEmptyClique) {
  EXPECT_TRUE(maximumClique(BitGraph(0)).empty());
}

TEST(MaxCliqueTest, NodesOutsideTheGraphThrow) {
  BitGraph graph(3);
  EXPECT_THROW(graph.join(0, 3), std::invalid_argument);
  EXPECT_THROW(graph.join(1, 1), std::invalid_argument);
}

}  // namespace
}  // namespace semantic_mht_slam
