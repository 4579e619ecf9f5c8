// The paper's own setting, config/paper.yaml, end to end: what its keys are, that they are in force, and that each of
// them does something.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "semantic_mht_slam/app/offline_runner.h"
#include "semantic_mht_slam/app/system_config.h"
#include "semantic_mht_slam/common/text.h"
#include "semantic_mht_slam/evaluation/loop_score.h"
#include "semantic_mht_slam/io/yaml_file.h"

#include "support/simulated_rounds.h"

namespace semantic_mht_slam {
namespace {

/// Keys of the file that have this value by default, too; all others of its keys switch something.
const std::set<std::string> kSameAsDefault = {"class_table",
                                              "method",
                                              "seed",
                                              "semantics",
                                              "measurement_model",
                                              "evaluator.tree",
                                              "close_loops",
                                              "recognise_places",
                                              "landmark_factors",
                                              "place.paper.scene.formula",
                                              "place.paper.filter.enter_prob",
                                              "place.paper.filter.stay_prob"};

std::string paperFile() {
  return packageConfigFile("paper.yaml");
}

/// The values of a configuration by their keys.
std::map<std::string, std::string> valuesOf(SystemConfig config) {
  Fields fields;
  describe(config, fields);
  std::map<std::string, std::string> values;
  for (const Field& field : fields.all()) values[field.key] = field.get();
  return values;
}

/// The paper's setting, with some keys put to other values.
SlamConfig paperConfig(const std::vector<Setting>& overrides = {}) {
  return loadableSlamConfig(loadSystemConfig(paperFile(), overrides), "");
}

const ClassTable& classes() {
  static const ClassTable kTable = readClassTable(packageConfigFile("classes_semantic_kitti.yaml"));
  return kTable;
}

const SimulatedDrive& drive() {
  static const SimulatedDrive kDrive = simulateRounds(classes());
  return kDrive;
}

RunResult run(const SlamConfig& config) {
  return runOffline(toRecording(drive()), config, classes(), [](std::size_t, std::size_t) {});
}

const RunResult& paperRun() {
  static const RunResult kResult = run(paperConfig());
  return kResult;
}

/// All that a run says of the drive, as text: equal texts, equal results.
std::string textOf(const RunResult& result) {
  std::string text;
  const auto add = [&text](const Eigen::Vector3d& position_m) {
    for (int axis = 0; axis < 3; ++axis) text += formatDouble(position_m(axis)) + " ";
  };
  for (const StampedPose& pose : result.trajectory) add(pose.T_world_base.translation_m);
  for (const StampedPose& pose : result.online_trajectory) add(pose.T_world_base.translation_m);
  for (const MixtureLandmark& landmark : result.landmarks) add(landmark.position.mean_m);
  for (const LoopClosureResult& closure : result.loop_closures) add(closure.record.T_match_query.translation_m);
  for (const int hypotheses : result.hypotheses) text += std::to_string(hypotheses) + " ";
  return text + std::to_string(result.submaps);
}

TEST(PaperSettingTest, EveryKeyOfTheFileIsInForceAsItIsWritten) {
  const std::map<std::string, std::string> in_force = valuesOf(loadSystemConfig(paperFile(), {}));
  std::set<std::string> seen;
  for (const Setting& setting : readSettings(paperFile())) {
    EXPECT_TRUE(seen.insert(setting.key).second) << setting.key;
    const auto written = parseDouble(setting.value);
    const std::string& value = in_force.at(setting.key);
    if (written) {
      EXPECT_EQ(parseDouble(value), written) << setting.key;
    } else {
      EXPECT_EQ(value, setting.value) << setting.key;
    }
  }
}

TEST(PaperSettingTest, EveryKeyOfTheFileDiffersFromTheDefaultOrIsSaidToBeTheSame) {
  const std::map<std::string, std::string> by_default = valuesOf(SystemConfig{});
  const std::map<std::string, std::string> in_force = valuesOf(loadSystemConfig(paperFile(), {}));
  std::set<std::string> written;
  for (const Setting& setting : readSettings(paperFile())) {
    written.insert(setting.key);
    EXPECT_EQ(in_force.at(setting.key) == by_default.at(setting.key), kSameAsDefault.count(setting.key) == 1)
        << setting.key;
  }
  for (const std::string& key : kSameAsDefault) EXPECT_EQ(written.count(key), 1U) << key;
  for (const auto& [key, value] : in_force) {
    EXPECT_TRUE(value == by_default.at(key) || written.count(key) == 1) << key << " is another without being written";
  }
}

TEST(PaperSettingTest, ADriveIsMappedAndClosedByThePapersChainAlone) {
  const RunResult& result = paperRun();
  std::vector<ClosureEstimate> closures;
  for (const auto& [query_frame, match_frame, record] : result.loop_closures) {
    EXPECT_EQ(record.source, ClosureSource::kPlace);
    EXPECT_GE(record.place.histogram_divergence, 0.0) << "submaps are compared by their class histograms";
    EXPECT_GE(record.place.topology_score, -1.0);
    EXPECT_GE(record.place.loop_prob, 0.0);
    closures.push_back({static_cast<std::int64_t>(query_frame), static_cast<std::int64_t>(match_frame),
                        record.is_accepted, record.T_match_query.translation_m});
  }
  const ClosureScore score = closureScore(drive().T_map_base, closures);
  EXPECT_GE(score.accepted, 3);
  EXPECT_EQ(score.wrong, 0);
  EXPECT_GE(result.landmarks.size(), 50U);
  EXPECT_EQ(result.trajectory.size(), drive().stamps.size());
  const int most = *std::max_element(result.hypotheses.begin(), result.hypotheses.end());
  EXPECT_GT(most, 1);
  EXPECT_LE(most, paperConfig().mapper.tree.max_hypotheses);
}

TEST(PaperSettingTest, TheTreeDecidesByItsFeaturesWhichSubmapsAreSearched) {
  const RunResult& result = paperRun();
  ASSERT_EQ(result.submap_checks.size(), result.submaps);
  std::size_t searched = 0;
  for (const auto& [first_frame, check] : result.submap_checks) {
    EXPECT_EQ(check.is_checked, check.evaluation.worth_checking);
    searched += check.is_checked ? 1 : 0;
    if (!check.evaluation.features) continue;
    EXPECT_TRUE(std::isfinite(check.evaluation.features->entropy)) << "submap at frame " << first_frame;
    EXPECT_LT(check.evaluation.good_prob, 1.0) << "of a tree, not of a setting that searches everything";
  }
  EXPECT_GT(searched, 0U);
  EXPECT_LT(searched, result.submaps) << "where there is next to nothing to see, nothing is searched";
}

TEST(PaperSettingTest, EachSwitchChangesWhatComesOut) {
  const std::map<std::string, std::string> by_default = valuesOf(SystemConfig{});
  // What these do shows where classes are not certain, where existence is judged, and where drift is larger than the
  // gate.
  const std::map<std::string, std::vector<Setting>> shows_with = {
      {"learn_confusion", {{"class_model", "confusion", "test"}}},
      {"clutter.learn", {{"detection.missed_detections", "true", "test"}}},
      {"place.drift_gate", {{"place.gate_base", "0", "test"}, {"place.gate_per_driven", "0", "test"}}}};
  EXPECT_TRUE(textOf(run(paperConfig())) == textOf(paperRun())) << "the same configuration gives the same result";
  for (const Setting& setting : readSettings(paperFile())) {
    if (kSameAsDefault.count(setting.key) == 1) continue;
    std::vector<Setting> overrides;
    if (shows_with.count(setting.key) == 1) overrides = shows_with.at(setting.key);
    const std::string with = overrides.empty() ? textOf(paperRun()) : textOf(run(paperConfig(overrides)));
    overrides.push_back({setting.key, by_default.at(setting.key), "test"});
    EXPECT_TRUE(textOf(run(paperConfig(overrides))) != with) << setting.key << " as by default changes nothing";
  }
}

}  // namespace
}  // namespace semantic_mht_slam
