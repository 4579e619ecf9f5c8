#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include <boost/program_options.hpp>

#include "semantic_mht_slam/bags/map_file.h"
#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/common/stopwatch.h"
#include "semantic_mht_slam/io/output_file.h"
#include "semantic_mht_slam/io/text_file.h"
#include "semantic_mht_slam/io/trajectory_file.h"
#include "semantic_mht_slam/merging/map_merger.h"
#include "semantic_mht_slam/slam/slam_parts_state.h"

#include "landmark_table.h"
#include "merge_maps_input.h"
#include "merge_maps_report.h"
#include "program.h"

namespace po = boost::program_options;

namespace semantic_mht_slam {
namespace {

constexpr const char* kUsage =
    "Joins maps of several drives or robots into one, without knowing where they began.\n"
    "  merge_maps A.bag B.bag ... --output ALL.bag [--report FILE.json]\n"
    "A map is a map file, or a text file of landmarks (class x y z). What is not known to belong together stays "
    "apart.\n"
    "Beside ALL.bag: trajectory_<map>.tum of each map in it, landmarks.csv, and the report as JSON and HTML.\n";

struct Arguments {
  std::vector<std::string> maps;
  std::string output;
  std::string report;
  std::string config = packageConfigFile("kitti.yaml");
  std::vector<std::string> settings;
};

/// False if only help was asked for.
bool parse(int argc, char** argv, Arguments& arguments) {
  po::options_description options("Options");
  auto add = options.add_options();
  add("map", po::value(&arguments.maps)->value_name("FILE"), "a map; the option's name may be left out");
  add("output", po::value(&arguments.output)->value_name("FILE"), "the joined map");
  add("report", po::value(&arguments.report)->value_name("FILE"), "JSON; default: merge_report.json beside the map");
  add("config", po::value(&arguments.config)->value_name("FILE"), "parameters that the maps were made with");
  add("set", po::value(&arguments.settings)->value_name("KEY=VALUE")->composing(),
      "changes a parameter; may be given several times");
  po::positional_options_description positions;
  positions.add("map", -1);
  if (!parseOrHelp({argv + 1, argv + argc}, kUsage, options, positions)) return false;
  if (arguments.maps.size() < 2) throw InputError("at least two maps are needed");
  if (arguments.output.empty()) throw InputError("--output is needed");
  return true;
}

std::vector<MemberResult> membersOf(const JoinedMap& joined, const std::vector<StampedPose>& trajectory) {
  std::vector<MemberResult> members;
  std::vector<std::vector<StampedPose>> trajectories = cutByMember(joined, trajectory);
  for (std::size_t m = 0; m < joined.members.size(); ++m) {
    members.push_back({joined.members[m].map->name(), std::move(trajectories[m])});
  }
  return members;
}

std::string fileNameFor(const MemberResult& member) {
  std::string name = std::filesystem::path(member.name).replace_extension().string();
  for (char& c : name) {
    if (c == '/') c = '_';
  }
  return "trajectory_" + name + ".tum";
}

int run(int argc, char** argv) {
  Arguments arguments;
  if (!parse(argc, argv, arguments)) return 0;
  MapInputs inputs = readMaps(arguments.maps, arguments.config, arguments.settings);
  const Stopwatch watch;
  const MergeResult result = mergeMaps(inputs.maps, inputs.slam_config, inputs.classes, {},
                                       [](const std::string& step) { std::fprintf(stderr, "%s\n", step.c_str()); });
  const double seconds = watch.elapsed_s();

  const std::filesystem::path folder = std::filesystem::path(absolutePath(arguments.output)).parent_path();
  prepareOutputFolder(folder.string());
  const JoinedMap& joined = *result.groups.front().joined;
  const MergeSettings settings = mergeSettings(inputs.maps, inputs.slam_config, inputs.classes);
  const std::vector<MixtureLandmark> landmarks = landmarksOf(joined);
  const auto trajectory = trajectoryOf(joined.parts.sessions.record(joined.parts.map));
  writeMapFile(arguments.output,
               {stateOf(settings.slam, joined.parts), landmarks, trajectory, joined.parts.map.submaps().size()},
               inputs.config, inputs.classes);
  const std::vector<MemberResult> members = membersOf(joined, trajectory);
  for (const MemberResult& member : members) {
    if (member.trajectory.empty()) continue;
    writeFileAtomically((folder / fileNameFor(member)).string(), formatTumTrajectory(member.trajectory));
  }
  writeFileAtomically((folder / "landmarks.csv").string(), landmarkTable(landmarks, inputs.classes));
  std::filesystem::path report = folder / "merge_report.json";
  if (!arguments.report.empty()) report = arguments.report;
  writeFileAtomically(report.string(), mergeReportJson(result, inputs.maps, landmarks.size(), seconds));
  writeFileAtomically(report.replace_extension(".html").string(),
                      mergeReportHtml(result, inputs.maps, members, landmarks));
  std::printf("%s\n", mergeSummary(result, inputs.maps).c_str());
  return 0;
}

}  // namespace
}  // namespace semantic_mht_slam

int main(int argc, char** argv) {
  return semantic_mht_slam::runProgram("merge_maps", [&] { return semantic_mht_slam::run(argc, argv); });
}
