#include "semantic_mht_slam/common/config.h"

#include <stdexcept>

#include <gtest/gtest.h>

#include "semantic_mht_slam/common/error.h"

namespace semantic_mht_slam {
namespace {

enum class Shape { kRound, kSquare };

struct InnerConfig {
  double length_m = 30.0;
  Shape shape = Shape::kRound;
};

struct OuterConfig {
  int count = 3;
  bool is_on = false;
  std::string name = "x";
  std::uint64_t seed = 1;
  InnerConfig inner;
};

void describe(InnerConfig& config, Fields& fields) {
  fields.add("length", config.length_m, "m", {1.0, 100.0}, "A length.");
  fields.add<Shape>("shape", config.shape, {{"round", Shape::kRound}, {"square", Shape::kSquare}}, "A shape.");
}

void describe(OuterConfig& config, Fields& fields) {
  fields.add("count", config.count, "", {1, 10}, "A count.");
  fields.add("is_on", config.is_on, "A switch.");
  fields.add("name", config.name, "A name.");
  fields.add("seed", config.seed, "", "A seed.");
  fields.group("inner", config.inner);
}

class ConfigTest : public ::testing::Test {
 protected:
  ConfigTest() { describe(config_, fields_); }

  std::vector<std::string> problemsOf(const std::vector<Setting>& settings) {
    try {
      applySettings(settings, fields_);
    } catch (const ConfigError& error) {
      return error.problems();
    }
    return {};
  }

  OuterConfig config_;
  Fields fields_;
};

TEST_F(ConfigTest, SettingsReachTheirFieldsAndLaterOnesWin) {
  applySettings({{"inner.length", "5.5", "f:1"},
                 {"inner.shape", "square", "f:2"},
                 {"is_on", "true", "f:3"},
                 {"count", "4", "f:4"},
                 {"count", "5", "--set"},
                 {"seed", "18000000000", "f:5"},
                 {"name", "a b", "f:6"}},
                fields_);
  EXPECT_EQ(config_.inner.length_m, 5.5);
  EXPECT_EQ(config_.inner.shape, Shape::kSquare);
  EXPECT_TRUE(config_.is_on);
  EXPECT_EQ(config_.count, 5);
  EXPECT_EQ(config_.seed, 18000000000ULL);
  EXPECT_EQ(config_.name, "a b");
}

TEST_F(ConfigTest, AllProblemsAreReportedTogetherAndNothingChanges) {
  const auto problems = problemsOf({{"inner.lenght", "5", "f:1"},
                                    {"inner.length", "0.5", "f:2"},
                                    {"count", "2.5", "f:3"},
                                    {"inner.shape", "flat", "f:4"},
                                    {"is_on", "yes", "f:5"},
                                    {"seed", "-1", "f:6"},
                                    {"name", "changed", "f:7"},
                                    {"count", "nan", "f:8"},
                                    {"inner.length", "nan", "f:9"}});
  ASSERT_EQ(problems.size(), 8U);
  EXPECT_EQ(problems[0], "f:1: unknown key 'inner.lenght', did you mean 'inner.length'?");
  EXPECT_EQ(problems[1], "f:2: inner.length = '0.5' is out of range (1 to 100)");
  EXPECT_EQ(problems[3], "f:4: inner.shape = 'flat' is none of round, square");
  EXPECT_EQ(config_.name, "x");
  EXPECT_EQ(config_.count, 3);
}

TEST_F(ConfigTest, AKeyThatMovedToAnotherGroupIsPointedAtThere) {
  const auto problems = problemsOf({{"somewhere.else.shape", "round", "f:1"}});
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_EQ(problems[0], "f:1: unknown key 'somewhere.else.shape', did you mean 'inner.shape'?");
}

TEST_F(ConfigTest, YamlNestsByDots) {
  EXPECT_EQ(toYaml(fields_), "count: 3\nis_on: false\nname: 'x'\nseed: 1\ninner:\n  length: 30\n  shape: round\n");
}

TEST_F(ConfigTest, ReferenceNamesUnitRangeDefaultAndHelpOfEveryKey) {
  const std::string reference = toMarkdown(fields_);
  EXPECT_NE(reference.find("| `inner.length` | number | m | 1 to 100 | 30 | A length. |"), std::string::npos);
  for (const Field& field : fields_.all()) EXPECT_NE(reference.find("`" + field.key + "`"), std::string::npos);
}

TEST_F(ConfigTest, AKeyDescribedTwiceIsAnErrorOfTheProgram) {
  EXPECT_THROW(describe(config_, fields_), std::logic_error);
}

}  // namespace
}  // namespace semantic_mht_slam
