#include <cmath>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <boost/program_options.hpp>

#include "semantic_mht_slam/app/offline_runner.h"
#include "semantic_mht_slam/app/recording.h"
#include "semantic_mht_slam/app/result_files.h"
#include "semantic_mht_slam/app/system_config.h"
#include "semantic_mht_slam/bags/bag_file.h"
#include "semantic_mht_slam/bags/map_file.h"
#include "semantic_mht_slam/bags/readable_map.h"
#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/io/dataset.h"
#include "semantic_mht_slam/io/existing_path.h"
#include "semantic_mht_slam/io/staged_folder.h"

#include "program.h"
#include "progress.h"

namespace po = boost::program_options;

namespace semantic_mht_slam {
namespace {

constexpr const char* kUsage =
    "Runs the system on a data-set folder or a bag, as fast as it goes.\n"
    "  slam_offline --dataset DIR [--objects FILE] [--odometry FILE] [--fixes FILE] --output DIR\n"
    "  slam_offline --bag FILE [--odometry-topic TOPIC] [--objects-topic TOPIC] [--fixes-topic TOPIC] --output DIR\n"
    "  slam_offline --print-config [--config FILE] [--set KEY=VALUE ...]\n"
    "With --load MAP it goes on with the map of an earlier run (DIR/map.bag).\n";

struct Arguments {
  std::string config = packageConfigFile("kitti.yaml");
  std::string bag;
  std::string map;
  std::string output;
  DatasetFiles dataset;
  BagLayout topics;
  std::vector<std::string> settings;
  std::string method;
  std::string seed;
  bool only_config = false;
};

po::options_description makeOptions(Arguments& arguments) {
  po::options_description options("Options");
  auto add = options.add_options();
  add("config", po::value(&arguments.config)->value_name("FILE"),
      "parameters, a file or the name of one of the package's: kitti.yaml (default), paper.yaml");
  add("dataset", po::value(&arguments.dataset.folder)->value_name("DIR"), "folder with times.txt, calib.txt, ...");
  add("objects", po::value(&arguments.dataset.objects)->value_name("FILE"), "objects CSV; default: objects.csv");
  add("odometry", po::value(&arguments.dataset.odometry)->value_name("FILE"),
      "odometry in KITTI format; default: odometry/vo_orb.txt");
  add("bag", po::value(&arguments.bag)->value_name("FILE"), "bag with objects and odometry, in place of --dataset");
  add("odometry-topic", po::value(&arguments.topics.odometry_topic)->value_name("TOPIC"),
      "odometry of the bag; default: /odometry");
  add("objects-topic", po::value(&arguments.topics.objects_topic)->value_name("TOPIC"),
      "objects of the bag; default: /objects");
  add("fixes", po::value(&arguments.dataset.fixes)->value_name("FILE"),
      "positions by satellites, CSV (docs/gnss.md); default: none");
  add("fixes-topic", po::value(&arguments.topics.fixes_topic)->value_name("TOPIC"),
      "the same of the bag, sensor_msgs/NavSatFix; default: /fix, if it is there");
  add("load", po::value(&arguments.map)->value_name("MAP"), "map file to go on with");
  add("method", po::value(&arguments.method)->value_name("NAME"), "the same as --set method=NAME");
  add("seed", po::value(&arguments.seed)->value_name("N"), "the same as --set seed=N");
  add("set", po::value(&arguments.settings)->value_name("KEY=VALUE")->composing(),
      "changes a parameter; may be given several times");
  add("print-config", po::bool_switch(&arguments.only_config),
      "prints the parameters as they are in force, runs nothing");
  add("output", po::value(&arguments.output)->value_name("DIR"), "folder for the results; made if missing");
  return options;
}

/// A file of that name, else the package's own one.
std::string locateConfig(const std::string& name) {
  return !mayExist(name) && mayExist(packageConfigFile(name)) ? packageConfigFile(name) : name;
}

void requireInputAndOutput(const Arguments& arguments) {
  if (arguments.bag.empty() == arguments.dataset.folder.empty())
    throw InputError("one of --dataset and --bag is needed");
  if (arguments.output.empty()) throw InputError("--output is needed");
  if (!arguments.bag.empty() && !arguments.dataset.fixes.empty())
    throw InputError("--fixes goes with --dataset; fixes of a bag are on a topic of it (--fixes-topic)");
  if (arguments.bag.empty() && !arguments.topics.fixes_topic.empty())
    throw InputError("--fixes-topic goes with --bag; fixes beside a data set are in a file (--fixes)");
}

SystemConfig loadConfig(const Arguments& arguments) {
  std::vector<Setting> overrides;
  for (const std::string& text : arguments.settings) overrides.push_back(parseOverride(text));
  if (!arguments.method.empty()) overrides.push_back({"method", arguments.method, "--method"});
  if (!arguments.seed.empty()) overrides.push_back({"seed", arguments.seed, "--seed"});
  return loadSystemConfig(arguments.config, overrides);
}

Recording loadRecording(const Arguments& arguments, const ClassTable& classes, const SystemConfig& config) {
  if (!arguments.bag.empty()) return readBag(arguments.bag, classes, config.node, arguments.topics);
  Dataset dataset = readDataset(arguments.dataset, classes);
  printNotice("slam_offline", dataset.notice);
  printNotice("slam_offline", dataset.fixes_notice);
  return toRecording(std::move(dataset));
}

/// What has to be said of the odometry's beginnings; empty if there is one, in its place.
std::string describeSessions(const std::vector<SessionSummary>& sessions) {
  std::string text;
  if (sessions.size() > 1) text += "; " + std::to_string(sessions.size()) + " sessions";
  for (std::size_t s = 0; s < sessions.size(); ++s) {
    if (sessions[s].is_located) continue;
    text += "; session " + std::to_string(s + 1) + " was never found in the map: its trajectory is the odometry's";
  }
  return text;
}

void printSummary(const Recording& recording, const RunResult& result, const std::optional<TrajectoryError>& error,
                  const std::string& output) {
  std::printf("%zu frames in %.2f s", result.counters.frames, result.seconds);
  if (error) {
    std::printf("; error: SE3-aligned %.3f m, running %.3f +- %.3f m", error->se3_m, error->running_mean_m,
                error->running_std_m);
    if (std::isfinite(error->t_rel_percent)) std::printf(", t_rel %.3f %%", error->t_rel_percent);
  }
  if (const std::size_t unknown = result.counters.covariances_unknown) {
    std::printf("; %zu covariances left out, they say that nothing is known", unknown);
  }
  std::printf("%s; results in %s\n", describeSessions(result.sessions).c_str(), output.c_str());
  for (const std::string& line : droppedInput(result.counters, recording.refused, recording.names)) {
    std::printf("  %s\n", line.c_str());
  }
  if (result.fixes.received > 0) {
    std::printf("  %zu of %zu fixes used for keyframes; %s\n", result.fixes.used, result.fixes.received,
                result.geo_reference ? "the map has its place on the Earth"
                                     : "they don't determine where the map is, and have no effect");
  }
  for (const std::string& line : droppedFixes(result.fixes, recording.refused, recording.names)) {
    std::printf("  %s\n", line.c_str());
  }
}

int run(int argc, char** argv) {
  Arguments arguments;
  if (!parseOrHelp({argv + 1, argv + argc}, kUsage, makeOptions(arguments))) return 0;
  if (!arguments.only_config) requireInputAndOutput(arguments);

  arguments.config = locateConfig(arguments.config);
  SystemConfig config = loadConfig(arguments);
  requireUsableFrames(config.node);
  const std::string config_folder = std::filesystem::path(arguments.config).parent_path().string();
  config.class_table = locateClassTable(config, config_folder);
  config.slam.back_end.evaluator.tree = locateEvaluatorTree(config, config_folder);
  const ClassTable classes = loadClassTable(config, config_folder);
  const SlamConfig slam_config = loadableSlamConfig(config, config_folder);
  if (arguments.only_config) {
    std::fputs(toYaml(config).c_str(), stdout);
    return 0;
  }
  const Recording recording = loadRecording(arguments, classes, config);
  std::optional<SlamState> map;
  if (!arguments.map.empty()) {
    LoadedMap loaded = readMapFile(arguments.map, config, classes, [] { return true; });
    if (!loaded.remade.empty()) std::fprintf(stderr, "%s\n", describeRemade(loaded).c_str());
    map = stateOf(std::move(loaded), slam_config, classes);
  }
  StagedFolder output(arguments.output);

  Progress progress("frames");
  const RunResult result = runOffline(
      recording, slam_config, classes, [&](std::size_t done, std::size_t all) { progress(done, all); },
      map ? &*map : nullptr);
  writeResultFiles(output.staging(), recording, result, config, classes);
  const std::size_t map_bytes =
      writeMapFile(output.staging() + "/map.bag",
                   {result.state, result.landmarks, result.whole_trajectory, result.submaps}, config, classes);
  const std::optional<TrajectoryError> error = scoreRun(recording, result.trajectory);
  writeReport(output.staging(), recording, result, error, config, map_bytes);
  output.commit();
  printSummary(recording, result, error, arguments.output);
  return 0;
}

}  // namespace
}  // namespace semantic_mht_slam

int main(int argc, char** argv) {
  return semantic_mht_slam::runProgram("slam_offline", [&] { return semantic_mht_slam::run(argc, argv); });
}
