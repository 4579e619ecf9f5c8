#include "semantic_mht_slam/ros/hypothesis_history.h"

#include <cmath>
#include <set>

#include <gtest/gtest.h>

namespace semantic_mht_slam {
namespace {

struct Leaf {
  std::uint64_t id;
  std::uint64_t parent;
  double weight;
  std::uint32_t age;
};

HypothesisTree treeOf(const std::vector<Leaf>& leaves, std::uint32_t submap = 0) {
  HypothesisTree message;
  message.submap = submap;
  for (const Leaf& leaf : leaves) {
    message.hypotheses.emplace_back();
    message.hypotheses.back().id = leaf.id;
    message.hypotheses.back().parent_id = leaf.parent;
    message.hypotheses.back().weight = leaf.weight;
    message.hypotheses.back().age = leaf.age;
  }
  return message;
}

DrawnHypothesis find(const std::vector<DrawnHypothesis>& drawn, std::uint64_t id) {
  for (const DrawnHypothesis& hypothesis : drawn) {
    if (hypothesis.id == id) return hypothesis;
  }
  ADD_FAILURE() << id << " is not drawn";
  return {};
}

TEST(HypothesisHistoryTest, ABranchingIsATreeWithWhatWasDropped) {
  HypothesisHistory history;
  for (int frame = 0; frame < 4; ++frame) history.add(treeOf({{1, 0, 1.0, 0}}));
  history.add(treeOf({{2, 1, 0.7, 0}, {3, 1, 0.3, 0}}));
  history.add(treeOf({{2, 1, 0.8, 1}, {3, 1, 0.2, 1}}));
  for (std::uint32_t age = 2; age < 6; ++age) history.add(treeOf({{2, 1, 1.0, age}}));
  const std::vector<DrawnHypothesis> drawn = history.drawn(100);
  ASSERT_EQ(drawn.size(), 3U);
  EXPECT_EQ(HypothesisHistory::rows(drawn), 2U);
  const DrawnHypothesis root = find(drawn, 1);
  const DrawnHypothesis kept = find(drawn, 2);
  const DrawnHypothesis dropped = find(drawn, 3);
  EXPECT_TRUE(root.leads_to_living && !root.is_living);
  EXPECT_TRUE(kept.is_living && !dropped.is_living && !dropped.leads_to_living);
  EXPECT_EQ(root.row, 0.5 * (kept.row + dropped.row));
  EXPECT_EQ(kept.parent_row, root.row);
  EXPECT_EQ(root.end, kept.begin) << "it ends where it branches";
  EXPECT_EQ(kept.end, 1.0);
  EXPECT_LT(dropped.end, 1.0);
  EXPECT_GT(dropped.end, dropped.begin);
  EXPECT_EQ(kept.weight, 1.0);
}

TEST(HypothesisHistoryTest, WhatBranchesInTheNewestFrameLivesNoMore) {
  HypothesisHistory history;
  history.add(treeOf({{1, 0, 1.0, 0}}));
  history.add(treeOf({{1, 0, 0.59, 1}, {2, 0, 0.41, 0}}));
  history.add(treeOf({{3, 1, 0.24, 0}, {4, 2, 0.5, 0}, {5, 2, 0.26, 0}}));
  const std::vector<DrawnHypothesis> drawn = history.drawn(100);
  const DrawnHypothesis parent = find(drawn, 1);
  EXPECT_TRUE(parent.leads_to_living && !parent.is_living);
  EXPECT_EQ(parent.weight, 0.0);
  EXPECT_EQ(parent.end, 1.0);
  EXPECT_TRUE(find(drawn, 3).is_living);
  EXPECT_EQ(HypothesisHistory::rows(drawn), 3U);
}

TEST(HypothesisHistoryTest, WhatLivesHasARowOfItsOwnThatLabelsDoNotOverlap) {
  HypothesisHistory history;
  history.add(treeOf({{1, 0, 0.6, 0}, {2, 0, 0.4, 0}}));
  // 1 lives on beside its one child, 2 beside its three; 6 has a child of its own.
  const std::vector<Leaf> leaves = {{1, 0, 0.59, 1}, {3, 1, 0.24, 0}, {2, 0, 0.05, 1}, {4, 2, 0.04, 0},
                                    {5, 2, 0.03, 0}, {6, 2, 0.03, 0}, {7, 6, 0.02, 0}};
  history.add(treeOf(leaves));
  const std::vector<DrawnHypothesis> drawn = history.drawn(100);
  ASSERT_EQ(drawn.size(), leaves.size());
  std::set<double> rows;
  for (const DrawnHypothesis& hypothesis : drawn) {
    EXPECT_TRUE(hypothesis.is_living);
    EXPECT_EQ(hypothesis.row, std::floor(hypothesis.row)) << hypothesis.id;
    EXPECT_TRUE(rows.insert(hypothesis.row).second) << hypothesis.id << " lies on another one";
  }
  EXPECT_EQ(HypothesisHistory::rows(drawn), leaves.size()) << "and no row is empty";
  EXPECT_EQ(find(drawn, 3).parent_row, find(drawn, 1).row);
}

TEST(HypothesisHistoryTest, TheNextSubmapBeginsAnewAndNoHypothesesAreNoTree) {
  HypothesisHistory history;
  history.add(treeOf({{1, 0, 1.0, 0}}));
  history.add(treeOf({{7, 0, 1.0, 0}}, 1));
  ASSERT_EQ(history.drawn(100).size(), 1U);
  EXPECT_EQ(history.drawn(100)[0].id, 7U);
  history.add(treeOf({}, 1));
  EXPECT_TRUE(history.drawn(100).empty());
  EXPECT_EQ(HypothesisHistory::rows({}), 0U);
}

TEST(HypothesisHistoryTest, ALongSubmapKeepsLittle) {
  HypothesisHistory history;
  std::uint64_t id = 1;
  for (int frame = 0; frame < 3000; ++frame, id += 2) {
    history.add(treeOf({{id + 1, id - 1, 0.9, 0}, {id + 2, id - 1, 0.1, 0}}));
  }
  EXPECT_LT(history.drawn(60).size(), 200U);
}

}  // namespace
}  // namespace semantic_mht_slam
