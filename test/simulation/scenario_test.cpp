#include "semantic_mht_slam/simulation/scenario.h"

#include <limits>

#include <gtest/gtest.h>

#include "semantic_mht_slam/common/error.h"

#include "scenario_files.h"

namespace semantic_mht_slam {
namespace {

/// The message of the error that `validate` throws; empty if it throws none.
std::string problemsOf(const Scenario& scenario) {
  try {
    validate(scenario);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

std::string asYaml(Scenario scenario) {
  Fields fields;
  describe(scenario, fields);
  return toYaml(fields);
}

class ShippedScenarioTest : public testing::TestWithParam<const char*> {};

TEST_P(ShippedScenarioTest, IsValid) {
  EXPECT_EQ(problemsOf(shippedScenario(GetParam())), "");
}

INSTANTIATE_TEST_SUITE_P(All, ShippedScenarioTest,
                         testing::Values("town", "town_camera", "parallel_streets", "opposite_direction", "short"));

TEST(ScenarioTest, DefaultsAreTheDemoTown) {
  EXPECT_EQ(asYaml(Scenario()), asYaml(shippedScenario("town")));
}

TEST(ScenarioTest, EveryParameterHasAHelpThatIsASentence) {
  Scenario scenario;
  Fields fields;
  describe(scenario, fields);
  for (const Field& field : fields.all()) {
    ASSERT_FALSE(field.help.empty()) << field.key;
    EXPECT_EQ(field.help.back(), '.') << field.key;
  }
}

TEST(ScenarioTest, DescribedParametersSurviveWritingAndReading) {
  Scenario scenario;
  scenario.classes[TownClass::kPole].half_range_m = 12.5;
  scenario.network.rows = 7;
  Fields from;
  describe(scenario, from);
  std::vector<Setting> settings;
  for (const Field& field : from.all()) settings.push_back({field.key, field.get(), "test"});
  Scenario copy;
  Fields to;
  describe(copy, to);
  applySettings(settings, to);
  EXPECT_EQ(copy.classes[TownClass::kPole].half_range_m, 12.5);
  EXPECT_EQ(asYaml(copy), asYaml(scenario));
}

TEST(ScenarioTest, AnEmptyNetworkIsRefusedByName) {
  Scenario scenario;
  scenario.network.columns = 0;
  EXPECT_NE(problemsOf(scenario).find("network.columns"), std::string::npos);
}

TEST(ScenarioTest, AllProblemsAreReportedTogether) {
  Scenario scenario;
  scenario.route.length_m = std::numeric_limits<double>::quiet_NaN();
  scenario.detector.clutter_mean = -1.0;
  scenario.classes[TownClass::kFence].length_min_m = 30.0;
  scenario.detector.max_range_m = 100.0;
  scenario.route.same_direction_fraction = 0.6;
  scenario.route.opposite_direction_fraction = 0.6;
  const std::string problems = problemsOf(scenario);
  for (const char* key : {"route.length", "detector.clutter_mean", "classes.fence.length", "passes.radius",
                          "route.opposite_direction_fraction"}) {
    EXPECT_NE(problems.find(key), std::string::npos) << key << " in " << problems;
  }
}

}  // namespace
}  // namespace semantic_mht_slam
