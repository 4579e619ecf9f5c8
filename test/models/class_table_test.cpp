#include "semantic_mht_slam/models/class_table.h"

#include <gtest/gtest.h>

#include "semantic_mht_slam/common/error.h"

namespace semantic_mht_slam {
namespace {

ClassInfo makeClass(int id, const std::string& name) {
  ClassInfo info;
  info.id = id;
  info.name = name;
  return info;
}

std::size_t problemCount(const std::vector<ClassInfo>& classes) {
  try {
    const ClassTable table(classes, "table.yaml");
  } catch (const ConfigError& error) {
    for (const std::string& problem : error.problems()) EXPECT_EQ(problem.rfind("table.yaml", 0), 0U) << problem;
    return error.problems().size();
  }
  return 0;
}

TEST(ClassTableTest, FindsByNameAndIdAndKnowsWhatItLacks) {
  const ClassTable table({makeClass(7, "pole"), makeClass(3, "tree")}, "test");
  EXPECT_EQ(table.findName("tree"), 1);
  EXPECT_EQ(table.findId(7), 0);
  EXPECT_FALSE(table.findName("Tree"));
  EXPECT_FALSE(table.findId(4));
  EXPECT_EQ(table.names(), "pole, tree");
}

TEST(ClassTableTest, EveryProblemIsNamed) {
  EXPECT_EQ(problemCount({}), 1U);
  EXPECT_EQ(problemCount({makeClass(1, "a"), makeClass(1, "a")}), 2U);
  ClassInfo bad = makeClass(2, "");
  bad.color = "red";
  bad.transition = Transition::kGaussian;
  EXPECT_EQ(problemCount({bad}), 3U);
  EXPECT_EQ(problemCount({makeClass(1, "a"), makeClass(2, "b")}), 0U);
}

TEST(ClassTableTest, ColoursAreFractionsOfRedGreenAndBlue) {
  ClassInfo info;
  info.color = "#ff8000";
  EXPECT_EQ(info.rgb()[0], 1.0);
  EXPECT_NEAR(info.rgb()[1], 128.0 / 255.0, 1e-12);
  EXPECT_EQ(info.rgb()[2], 0.0);
}

}  // namespace
}  // namespace semantic_mht_slam
