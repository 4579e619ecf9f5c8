#include <cstdio>
#include <string>
#include <vector>

#include <boost/program_options.hpp>

#include "semantic_mht_slam/app/recording.h"
#include "semantic_mht_slam/app/simulated_dataset.h"
#include "semantic_mht_slam/app/system_config.h"
#include "semantic_mht_slam/bags/bag_file.h"
#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/common/text.h"
#include "semantic_mht_slam/io/dataset.h"
#include "semantic_mht_slam/io/staged_folder.h"
#include "semantic_mht_slam/io/yaml_file.h"
#include "semantic_mht_slam/simulation/simulator.h"

#include "program.h"

namespace po = boost::program_options;

namespace semantic_mht_slam {
namespace {

constexpr const char* kUsage =
    "Simulates a drive through a town: a data-set folder with truth, and the same drive as a bag (drive.bag).\n"
    "  simulate_drive [--scenario FILE] [--seed N] [--set KEY=VALUE ...] --output DIR\n";

struct Arguments {
  std::string scenario = packageConfigFile("scenarios/town.yaml");
  std::vector<std::string> settings;
  std::string seed = "1";
  std::string output;
};

po::options_description makeOptions(Arguments& arguments) {
  po::options_description options("Options");
  auto add = options.add_options();
  add("scenario", po::value(&arguments.scenario)->value_name("FILE"), "default: the package's scenarios/town.yaml");
  add("seed", po::value(&arguments.seed)->value_name("N"), "same scenario and seed, same bytes; default: 1");
  add("set", po::value(&arguments.settings)->value_name("KEY=VALUE")->composing(),
      "changes a key of the scenario; may be given several times");
  add("output", po::value(&arguments.output)->value_name("DIR"), "folder for the drive; made if missing");
  return options;
}

std::uint64_t seedOf(const Arguments& arguments) {
  const auto seed = parseInteger(arguments.seed);
  if (!seed || *seed < 0) throw InputError("--seed " + arguments.seed + ": a whole number of at least 0 was expected");
  return static_cast<std::uint64_t>(*seed);
}

int run(int argc, char** argv) {
  Arguments arguments;
  if (!parseOrHelp({argv + 1, argv + argc}, kUsage, makeOptions(arguments))) return 0;
  if (arguments.output.empty()) throw InputError("--output is needed");

  const ClassTable classes = readClassTable(packageConfigFile("classes_semantic_kitti.yaml"));
  const SimulatedDrive drive =
      simulateDrive(loadScenario(arguments.scenario, arguments.settings), classes, seedOf(arguments));
  StagedFolder output(arguments.output);
  writeSimulatedDataset(drive, classes, output.staging());
  // The bag is made from the files, so that both hold the same digits.
  const DatasetFiles files{output.staging(), "objects.csv", "odometry/odometry.txt"};
  writeBag(output.staging() + "/drive.bag", toRecording(readDataset(files, classes)), classes, NodeConfig{},
           BagLayout{}, stampFromSeconds(1.0));
  output.commit();

  std::size_t objects = 0;
  for (const Detections& detections : drive.detections) objects += detections.size();
  std::printf("%zu frames, %zu objects of %zu landmarks, %zu loop pairs in %s\n", drive.stamps.size(), objects,
              drive.landmarks.size(), drive.loop_pairs.size(), arguments.output.c_str());
  return 0;
}

}  // namespace
}  // namespace semantic_mht_slam

int main(int argc, char** argv) {
  return semantic_mht_slam::runProgram("simulate_drive", [&] { return semantic_mht_slam::run(argc, argv); });
}
