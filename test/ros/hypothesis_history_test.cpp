#include "semantic_mht_slam/ros/hypothesis_history.h"

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
