#include "semantic_mht_slam/app/system_config.h"

#include <filesystem>
#include <utility>

#include "semantic_mht_slam/app/map_server_config.h"
#include "semantic_mht_slam/app/object_extractor_config.h"
#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/io/existing_path.h"
#include "semantic_mht_slam/io/output_file.h"
#include "semantic_mht_slam/io/yaml_file.h"
#include "semantic_mht_slam/simulation/scenario.h"

namespace semantic_mht_slam {
namespace {

namespace fs = std::filesystem;

/// The method that the settings choose, which decides the defaults of other keys. A wrong one is reported later, with
/// all other problems.
Method methodOf(const std::vector<Setting>& settings) {
  SlamConfig config;
  Fields fields;
  describe(config, fields);
  for (const Setting& setting : settings) {
    if (setting.key == "method") fields.all().front().set(setting.value);
  }
  return config.method;
}

/// A file that a configuration in `folder` names: as it stands if it is the package's own, else absolute.
std::string located(const std::string& name, const std::string& folder) {
  const fs::path beside = fs::path(folder) / name;
  std::error_code error;
  if (fs::equivalent(beside, packageConfigFile(name), error) || !mayExist(beside.string())) return name;
  return absolutePath(beside.string());
}

/// Where a located file can be opened.
std::string readable(const std::string& name) {
  return fs::path(name).is_absolute() ? name : packageConfigFile(name);
}

}  // namespace

void describe(NodeConfig& config, Fields& fields) {
  fields.add("map_frame", config.map_frame, "Name of the map frame.");
  fields.add("odom_frame", config.odom_frame, "Name of the odometry's frame; odometry in another frame is refused.");
  fields.add("base_frame", config.base_frame, "Name of the robot's base frame, the child frame of the odometry.");
  fields.add("queue_size", config.queue_size, "messages", {1, 1000000},
             "Messages that may wait for the estimator; beyond that the oldest objects are dropped and counted.");
  fields.add("max_delay", config.max_delay_s, "s", {0.1, 3600.0},
             "Wall time that objects may wait for the estimator; older ones are dropped and counted.");
  fields.add("tf_timeout", config.tf_timeout_s, "s", {0.0, 60.0},
             "How long objects wait for the transform of their sensor; odometry never waits for them.");
  fields.add("trajectory_period", config.trajectory_period_s, "s", {0.01, 60.0},
             "Wall time between publications of the trajectory.");
  fields.add(
      "trajectory_poses", config.trajectory_poses, "poses", {2, 10000000},
      "Most poses in the topics trajectory and markers/odometry; of longer drives every 2nd, 4th, ... is shown.");
  fields.add("ambiguous_below", config.ambiguous_below_prob, "", {0.0, 1.0},
             "The topic ambiguous_detections explains detections whose probability is below this,");
  fields.add("ambiguous_most", config.ambiguous_most, "detections", {0, 1000000},
             "but no more of a submap than these, the least sure ones.");
  fields.add("reset_after_jump_back", config.reset_after_jump_back_s, "s", {0.0, 3600.0},
             "Odometry whose stamp falls back by more than this starts a new map.");
  fields.add("publish_tf", config.publishes_tf, "Whether tf map -> odom is published; the topic pose says the same.");
  fields.add("map", config.map, "Map file to begin with, an absolute path; empty: a new map.");
  fields.add("map_folder", config.map_folder,
             "Folder outside of which no service reads or writes files; empty: anywhere.");
  fields.add<StartMode>("mode", config.mode,
                        {{"mapping", StartMode::kMapping}, {"localization", StartMode::kLocalization}},
                        "What the node begins with: mapping goes on in `map`, localization leaves it as it is.");
  fields.group("live", config.live);
}

void describe(SystemConfig& config, Fields& fields) {
  fields.add("class_table", config.class_table, "Class table file; relative to this file or to the package's config.");
  describe(config.slam, fields);
  fields.group("gnss", config.slam.gnss);
  fields.group("node", config.node);
}

SystemConfig makeSystemConfig(const std::vector<Setting>& settings) {
  SystemConfig config;
  config.slam = defaultsOf(methodOf(settings));
  Fields fields;
  describe(config, fields);
  applySettings(settings, fields);
  return config;
}

SystemConfig loadSystemConfig(const std::string& yaml_path, const std::vector<Setting>& overrides) {
  std::vector<Setting> settings = readSettings(yaml_path);
  for (Setting setting : overrides) {
    const bool names_file = setting.key == "class_table" || setting.key == "evaluator.tree";
    if (names_file && mayExist(setting.value) && !isFolder(setting.value)) setting.value = absolutePath(setting.value);
    settings.push_back(std::move(setting));
  }
  return makeSystemConfig(settings);
}

std::string toYaml(SystemConfig config) {
  Fields fields;
  describe(config, fields);
  return toYaml(fields);
}

std::string parameterReference() {
  SystemConfig config;
  Fields system;
  describe(config, system);
  ClassInfo info;
  Fields class_entry;
  describe(info, class_entry);
  Scenario scenario;
  Fields scenario_fields;
  describe(scenario, scenario_fields);
  ObjectExtractorConfig extractor;
  ClassInfo any_class;
  any_class.name = "NAME";
  extractor.extraction = ExtractionConfig(ClassTable({any_class}, ""));
  Fields extractor_fields;
  describe(extractor, extractor_fields);
  SegmentationNodeConfig segmentation;
  Fields segmentation_fields;
  describe(segmentation, segmentation_fields);
  MapServerConfig server;
  Fields server_fields;
  describe(server, server_fields);
  return "<!-- made by the program parameter_reference; do not edit -->\n# Parameters\n\n"
         "Keys of `config/kitti.yaml`, of `slam_offline --set KEY=VALUE` and, as private parameters with `/` in place "
         "of "
         "`.`,\nof `slam_node`.\n" +
         toMarkdown(system) + "\n# Class tables\n\nKeys of one entry of the list `classes`.\n" +
         toMarkdown(class_entry) + "\n# Scenarios\n\nKeys of the scenario files of `simulate_drive`.\n" +
         toMarkdown(scenario_fields) +
         "\n# Object extraction\n\nPrivate parameters of `object_extractor_node` and its nodelet; those from "
         "`min_range` on are the keys of "
         "`config/extraction.yaml`\nand of `extract_objects --set`. `classes.NAME` stands for each class of the table; "
         "the "
         "defaults shown are those of classes that\nkeep their place, `config/extraction.yaml` has the others'.\n" +
         toMarkdown(extractor_fields) + "\n# Segmentation\n\nPrivate parameters of `segmentation_node`.\n" +
         toMarkdown(segmentation_fields) +
         "\n# Map server\n\nPrivate parameters of `map_server`, beside those of `slam_node` that its maps were made "
         "with.\n" +
         toMarkdown(server_fields);
}

Setting parseOverride(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) throw InputError("--set " + text + ": key=value was expected");
  return {text.substr(0, equals), text.substr(equals + 1), "--set"};
}

std::string locateClassTable(const SystemConfig& config, const std::string& folder) {
  return located(config.class_table, folder);
}

std::string locateEvaluatorTree(const SystemConfig& config, const std::string& folder) {
  return located(config.slam.back_end.evaluator.tree, folder);
}

ClassTable loadClassTable(const SystemConfig& config, const std::string& folder) {
  return readClassTable(readable(locateClassTable(config, folder)));
}

SlamConfig loadableSlamConfig(const SystemConfig& config, const std::string& folder) {
  SlamConfig slam = config.slam;
  SubmapEvaluatorConfig& evaluator = slam.back_end.evaluator;
  evaluator.tree = readable(locateEvaluatorTree(config, folder));
  if (!evaluator.check_all) SubmapClassifier::load(evaluator.tree);
  return slam;
}

void requireUsableFrames(const NodeConfig& config) {
  std::vector<std::string> problems;
  const std::vector<std::pair<std::string, std::string>> frames = {{"node.map_frame", config.map_frame},
                                                                   {"node.odom_frame", config.odom_frame},
                                                                   {"node.base_frame", config.base_frame}};
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const auto& [key, name] = frames[i];
    if (name.empty() || name.front() == '/') problems.push_back(key + " = '" + name + "' is no name of a tf frame");
    for (std::size_t j = 0; j < i; ++j) {
      if (frames[j].second == name) problems.push_back(key + " and " + frames[j].first + " are both '" + name + "'");
    }
  }
  if (!problems.empty()) throw ConfigError(problems);
}

std::string packageConfigFile(const std::string& name) {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  const fs::path prefix = program.parent_path().parent_path().parent_path();  // PREFIX/lib/semantic_mht_slam/program
  const fs::path installed = prefix / "share" / "semantic_mht_slam" / "config" / name;
  if (!error && mayExist(installed.string())) return installed.string();
  return (fs::path(SEMANTIC_MHT_SLAM_SOURCE_CONFIG_DIR) / name).string();
}

}  // namespace semantic_mht_slam
