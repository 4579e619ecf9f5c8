#include "semantic_mht_slam/graph/loop_consistency.h"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "random_graph.h"

namespace semantic_mht_slam {
namespace {

constexpr int kRound = 20;  // of `randomGraph`: poses from one visit of a place to the next
constexpr double kOdometryScale = 2.0;
constexpr double kStreetShift_m = 0.25;  // too small for odometry to tell after one round

template <int kDim>
constexpr double kGate = kDim == 2 ? 11.345 : 16.812;  // 99 % quantile of chi-square

std::set<int> asSet(const std::vector<int>& items) {
  return {items.begin(), items.end()};
}

template <class Dimension>
class LoopConsistencyTest : public testing::Test {
 protected:
  static constexpr int kDim = Dimension::value;
  using Graph = BatchGraph<kDim>;
  using PoseType = typename Graph::PoseType;

  static LoopConsistency find(const Graph& graph) { return findConsistentLoops(graph, kGate<kDim>, kOdometryScale); }

  static std::set<int> loopsOf(const Graph& graph) {
    std::set<int> loops;
    for (int i = 0; i < static_cast<int>(graph.pose_edges.size()); ++i) {
      if (!isOdometry(graph.pose_edges[i])) loops.insert(i);
    }
    return loops;
  }

  /// Without the loop closures that come with the graph.
  static Graph odometryOnly(Graph graph) {
    auto& edges = graph.pose_edges;
    edges.erase(std::remove_if(edges.begin(), edges.end(), [](const auto& edge) { return !isOdometry(edge); }),
                edges.end());
    return graph;
  }

  /// Loop closures from the second round to the first as a street that looks alike and lies `shift_m` to the side of
  /// the right one would give them: all wrong by the same motion. Returns their indices.
  static std::set<int> addParallelStreet(Graph& graph, Rng& rng, int count, double shift_m) {
    std::vector<PoseType> truths(2 * kRound);
    for (int i = 1; i < 2 * kRound; ++i) {
      truths[i] = truths[i - 1] * circleStep(static_cast<const PoseType*>(nullptr));
    }
    PoseType shift;
    shift.translation_m.x() = shift_m;
    std::set<int> added;
    for (int i = kRound + 5; i < kRound + 5 + count; ++i) {
      const PoseType seen = truths[i].inverse() * shift * truths[i - kRound];
      added.insert(static_cast<int>(graph.pose_edges.size()));
      graph.pose_edges.push_back(
          {i, i - kRound, randomStep(rng, 0.02, 0.01, seen), graph.pose_edges.front().information});
    }
    return added;
  }

  static std::set<int> addRandomLoops(Graph& graph, Rng& rng, int count) {
    std::set<int> added;
    for (int i = 0; i < count; ++i) {
      const int from = kRound + static_cast<int>(rng.index(kRound));
      const int to = static_cast<int>(rng.index(kRound - 2));
      added.insert(static_cast<int>(graph.pose_edges.size()));
      graph.pose_edges.push_back(
          {from, to, randomStep(rng, 5.0, 1.0, PoseType{}), graph.pose_edges.front().information});
    }
    return added;
  }

  /// Expects that none of `wrong` is among the consistent ones and that nine of ten others are.
  static void expectSeparated(const Graph& graph, const std::set<int>& wrong, std::uint64_t seed) {
    const LoopConsistency result = find(graph);
    const std::set<int> kept = asSet(result.consistent);
    for (const int edge : wrong) EXPECT_EQ(kept.count(edge), 0U) << "wrong edge " << edge << ", seed " << seed;
    EXPECT_GE(10 * kept.size(), 9 * (loopsOf(graph).size() - wrong.size())) << "seed " << seed;
    std::set<int> all = asSet(result.inconsistent);
    all.insert(kept.begin(), kept.end());
    EXPECT_EQ(all, loopsOf(graph)) << "every loop closure is on one of the lists";
    EXPECT_EQ(kept.size() + result.inconsistent.size(), all.size()) << "and on one only";
  }
};

using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(LoopConsistencyTest, Dimensions);

constexpr std::uint64_t kSeeds = 10;

TYPED_TEST(LoopConsistencyTest, RightLoopClosuresAreKept) {
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    Rng rng(seed);
    this->expectSeparated(randomGraph<TypeParam::value>(rng), {}, seed);
  }
}

TYPED_TEST(LoopConsistencyTest, RandomWrongOnesAreFoundEvenIfTheyAreThreeTimesAsMany) {
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    Rng rng(seed);
    auto graph = randomGraph<TypeParam::value>(rng);
    const std::set<int> wrong = this->addRandomLoops(graph, rng, 3 * kRound);
    this->expectSeparated(graph, wrong, seed);
  }
}

TYPED_TEST(LoopConsistencyTest, WrongOnesThatAgreeWithEachOtherAreFoundIfTheyAreFewer) {
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    Rng rng(seed);
    auto graph = randomGraph<TypeParam::value>(rng);
    const std::set<int> wrong = this->addParallelStreet(graph, rng, 8, kStreetShift_m);
    this->expectSeparated(graph, wrong, seed);
  }
}

// The case above is one that odometry alone cannot decide: without the right ones, the wrong ones are believed.
TYPED_TEST(LoopConsistencyTest, WrongOnesThatAgreeWithEachOtherAndWithOdometryAreBelievedIfThereAreNoOthers) {
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    Rng rng(seed);
    auto graph = this->odometryOnly(randomGraph<TypeParam::value>(rng));
    this->addParallelStreet(graph, rng, 8, kStreetShift_m);
    EXPECT_GE(this->find(graph).consistent.size(), 7U) << "seed " << seed;
  }
}

TYPED_TEST(LoopConsistencyTest, WrongOnesThatAgreeWithEachOtherButContradictOdometryAreOutEvenAlone) {
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    Rng rng(seed);
    auto graph = this->odometryOnly(randomGraph<TypeParam::value>(rng));
    this->addParallelStreet(graph, rng, 8, 15.0);
    EXPECT_TRUE(this->find(graph).consistent.empty()) << "seed " << seed;
  }
}

TYPED_TEST(LoopConsistencyTest, LoopClosuresThatNoOdometryJoinsAreNotTested) {
  Rng rng(1);
  auto graph = randomGraph<TypeParam::value>(rng);
  auto& edges = graph.pose_edges;
  edges.erase(std::find_if(edges.begin(), edges.end(), [](const auto& edge) { return edge.to == kRound; }));
  EXPECT_EQ(asSet(this->find(graph).consistent), this->loopsOf(graph));
}

}  // namespace
}  // namespace semantic_mht_slam
