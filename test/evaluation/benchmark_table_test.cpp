#include "semantic_mht_slam/evaluation/benchmark_table.h"

#include <cmath>

#include <gtest/gtest.h>

#include "semantic_mht_slam/common/text.h"

namespace semantic_mht_slam {
namespace {

BenchmarkRun makeRun(const std::string& sequence, const std::string& method, std::uint64_t seed, double se3_m) {
  BenchmarkRun run;
  run.sequence = sequence;
  run.odometry = "vo";
  run.objects = "best";
  run.method = method;
  run.seed = seed;
  run.figures = {{"se3_m", se3_m},        {"running_mean_m", 2.0 * se3_m}, {"raw_se3_m", 2.0},
                 {"map_mb_per_km", 0.25}, {"closures_accepted", 3.0},      {"closures_wrong", 0.0}};
  return run;
}

/// The statement with `part` in its text.
Statement statementOn(const std::vector<BenchmarkRun>& runs, const std::string& part) {
  for (const Statement& statement : benchmarkStatements(runs)) {
    if (statement.text.find(part) != std::string::npos) return statement;
  }
  ADD_FAILURE() << "no statement on " << part;
  return {};
}

TEST(BenchmarkTableTest, GroupsHoldTheMedianAndTheRangeOfTheSeeds) {
  const auto groups = groupRuns({makeRun("00", "dpmhm", 1, 1.0), makeRun("00", "ukf", 1, 9.0),
                                 makeRun("00", "dpmhm", 2, 5.0), makeRun("00", "dpmhm", 3, 2.0)});
  ASSERT_EQ(groups.size(), 2U);
  EXPECT_EQ(groups[0].seeds, (std::vector<std::uint64_t>{1, 2, 3}));
  EXPECT_EQ(groups[0].figures[0].median, 2.0);
  EXPECT_EQ(groups[0].figures[0].min, 1.0);
  EXPECT_EQ(groups[0].figures[0].max, 5.0);
  EXPECT_EQ(medianOf(groups[1], "se3_m"), 9.0);
  EXPECT_TRUE(std::isnan(medianOf(groups[1], "none")));
}

TEST(BenchmarkTableTest, FailedRunsAreCountedAndLeaveTheFiguresAlone) {
  BenchmarkRun failed = makeRun("00", "dpmhm", 2, 0.0);
  failed.failure = "code 1";
  failed.figures.clear();
  const std::vector<BenchmarkRun> runs = {makeRun("00", "dpmhm", 1, 1.0), failed};
  const auto groups = groupRuns(runs);
  ASSERT_EQ(groups.size(), 1U);
  EXPECT_EQ(groups[0].failed, 1);
  EXPECT_EQ(groups[0].seeds.size(), 1U);
  EXPECT_EQ(medianOf(groups[0], "se3_m"), 1.0);
  EXPECT_FALSE(statementOn(runs, "FAILED").holds);
}

TEST(BenchmarkTableTest, AFigureThatIsUndefinedInOneRunIsTheMedianOfTheOthers) {
  const auto groups = groupRuns({makeRun("00", "dpmhm", 1, std::nan("")), makeRun("00", "dpmhm", 2, 3.0)});
  EXPECT_EQ(medianOf(groups.at(0), "se3_m"), 3.0);
}

TEST(BenchmarkTableTest, MethodMeansWeighEverySequenceAlikeWhateverItsSeeds) {
  BenchmarkRun wrong = makeRun("05", "dpmhm", 1, 4.0);
  wrong.figures.back().second = 2.0;
  const auto methods = summarizeMethods({makeRun("00", "dpmhm", 1, 1.0), makeRun("00", "dpmhm", 2, 1.0), wrong});
  ASSERT_EQ(methods.size(), 1U);
  EXPECT_EQ(methods[0].groups, 2);
  EXPECT_EQ(figureOf(methods[0].means, "se3_m"), 2.5);
  EXPECT_EQ(methods[0].wrong_closures, 2.0);
}

TEST(BenchmarkTableTest, StatementsTellWhereTheFullSystemIsNotBetter) {
  const std::vector<BenchmarkRun> better_in_mean = {makeRun("00", "ukf", 1, 4.0), makeRun("00", "dpmhm", 1, 1.0),
                                                    makeRun("05", "ukf", 1, 1.0), makeRun("05", "dpmhm", 1, 2.0)};
  const Statement better = statementOn(better_in_mean, "than ukf");
  EXPECT_TRUE(better.holds);
  EXPECT_NE(better.text.find("better in 1 of them, not in 05 vo"), std::string::npos) << better.text;
  const Statement equal = statementOn({makeRun("00", "mhm", 1, 1.0), makeRun("00", "dpmhm", 1, 1.0)}, "than mhm");
  EXPECT_FALSE(equal.holds);
  EXPECT_NE(equal.text.find("NOT better"), std::string::npos) << equal.text;
}

TEST(BenchmarkTableTest, WhereTheFullSystemIsNotBetterItsFiguresSayWhy) {
  const auto reason = [](double own_f1, double other_f1, double own_recall, double other_recall) {
    BenchmarkRun own = makeRun("05", "dpmhm", 1, 1.0);
    BenchmarkRun other = makeRun("05", "mhm", 1, 0.5);
    own.figures.insert(own.figures.end(), {{"association_local_f1", own_f1}, {"closures_recall", own_recall}});
    other.figures.insert(other.figures.end(), {{"association_local_f1", other_f1}, {"closures_recall", other_recall}});
    const std::string text = statementOn({own, other}, "than mhm").text;
    EXPECT_NE(text.find("; why: association F1 " + formatFixed(own_f1, 3)), std::string::npos) << text;
    return text.substr(text.rfind(": ") + 2);
  };
  EXPECT_EQ(reason(0.7, 0.8, 1.0, 1.0), "its association is worse");
  EXPECT_EQ(reason(0.9, 0.8, 0.5, 1.0), "it closes fewer revisits");
  EXPECT_EQ(reason(0.9, 0.8, 1.0, 1.0).rfind("both close the same revisits", 0), 0U);
  const Statement silent = statementOn({makeRun("00", "mhm", 1, 0.5), makeRun("00", "dpmhm", 1, 1.0)}, "than mhm");
  EXPECT_EQ(silent.text.find("why"), std::string::npos) << "nothing is known";
}

TEST(BenchmarkTableTest, OnlyCasesThatBothMethodsHaveAreCompared) {
  const Statement statement = statementOn(
      {makeRun("00", "ukf", 1, 4.0), makeRun("00", "dpmhm", 1, 1.0), makeRun("05", "dpmhm", 1, 100.0)}, "than ukf");
  EXPECT_TRUE(statement.holds) << statement.text;
}

TEST(BenchmarkTableTest, ARunWorseThanItsOdometryByMoreThanTwoPercentIsNamed) {
  EXPECT_TRUE(statementOn({makeRun("00", "dpmhm", 1, 2.03)}, "worse than its odometry").holds);
  const Statement worse = statementOn({makeRun("00", "dpmhm", 1, 1.0), makeRun("00", "dpmhm", 7, 2.05)}, "WORSE");
  EXPECT_FALSE(worse.holds);
  EXPECT_NE(worse.text.find("seed 7 (2.5 %)"), std::string::npos) << worse.text;
}

TEST(BenchmarkTableTest, AWrongLoopClosureOfAnyMethodIsNamed) {
  std::vector<BenchmarkRun> runs = {makeRun("00", "dpmhm", 1, 1.0), makeRun("00", "mhm", 4, 1.0)};
  EXPECT_TRUE(statementOn(runs, "6 loop closures accepted").holds);
  runs[1].figures.back().second = 1.0;
  const Statement wrong = statementOn(runs, "WRONG");
  EXPECT_FALSE(wrong.holds);
  EXPECT_NE(wrong.text.find("mhm seed 4"), std::string::npos) << wrong.text;
}

TEST(BenchmarkTableTest, LargeMapsAreTold) {
  BenchmarkRun run = makeRun("00", "dpmhm", 1, 1.0);
  EXPECT_TRUE(statementOn({run}, "largest map").holds);
  run.figures[3].second = 1.5;
  EXPECT_FALSE(statementOn({run}, "largest map").holds);
}

}  // namespace
}  // namespace semantic_mht_slam
