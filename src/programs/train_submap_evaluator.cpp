#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include <boost/program_options.hpp>

#include "semantic_mht_slam/app/system_config.h"
#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/common/text.h"
#include "semantic_mht_slam/io/text_file.h"

#include "program.h"
#include "progress.h"
#include "train_submap_evaluator_drives.h"
#include "train_submap_evaluator_validation.h"

namespace po = boost::program_options;

namespace semantic_mht_slam {
namespace {

constexpr const char* kUsage =
    "Trains the decision tree that picks the submaps worth a search for loop closures, on drives whose truth is "
    "known.\n"
    "A submap is worth it if a place in it was driven through before and landmarks of it were mapped then.\n"
    "  train_submap_evaluator --scenario FILE ... [--seeds A-B] [--dataset DIR ...] --output FILE\n"
    "  train_submap_evaluator --scenario FILE ... [--seeds A-B] [--dataset DIR ...] --test FILE\n";

struct Arguments {
  std::string config = packageConfigFile("kitti.yaml");
  std::vector<std::string> settings;
  std::vector<std::string> scenarios;
  std::string seeds = "1-5";
  std::vector<std::string> datasets;
  DatasetFiles files;
  double recall = 0.99;
  TreeTraining training;
  std::string test;
  std::string output;
};

po::options_description makeOptions(Arguments& arguments) {
  po::options_description options("Options");
  auto add = options.add_options();
  add("scenario", po::value(&arguments.scenarios)->value_name("FILE")->composing(),
      "scenario to simulate; may be given several times");
  add("seeds", po::value(&arguments.seeds)->value_name("A-B"), "simulated drives of each scenario; default: 1-5");
  add("dataset", po::value(&arguments.datasets)->value_name("DIR")->composing(),
      "recorded drive with poses.txt; may be given several times");
  add("objects", po::value(&arguments.files.objects)->value_name("FILE"), "of each data set; default: objects.csv");
  add("odometry", po::value(&arguments.files.odometry)->value_name("FILE"),
      "of each data set; default: odometry/vo_orb.txt");
  add("config", po::value(&arguments.config)->value_name("FILE"), "parameters; default: the package's kitti.yaml");
  add("set", po::value(&arguments.settings)->value_name("KEY=VALUE")->composing(),
      "changes a parameter; may be given several times");
  add("recall", po::value(&arguments.recall)->value_name("SHARE"),
      "share of the revisits to keep in cross-validation; default: 0.99");
  add("max-depth", po::value(&arguments.training.max_depth)->value_name("N"), "of the tree; default: 3");
  add("min-samples", po::value(&arguments.training.min_samples)->value_name("N"),
      "submaps that a node must hold to be split; default: 100");
  add("test", po::value(&arguments.test)->value_name("FILE"), "trains nothing, but scores this tree on the drives");
  add("output", po::value(&arguments.output)->value_name("FILE"), "YAML file of the tree");
  return options;
}

void requireUsable(const Arguments& arguments) {
  if (arguments.output.empty() == arguments.test.empty()) throw InputError("one of --output and --test is needed");
  if (arguments.scenarios.empty() && arguments.datasets.empty()) throw InputError("--scenario or --dataset is needed");
  if (!(arguments.recall > 0.0 && arguments.recall <= 1.0)) throw InputError("--recall must be above 0 and at most 1");
  if (arguments.training.max_depth < 1 || arguments.training.max_depth > 25) {
    throw InputError("--max-depth must be from 1 to 25");
  }
  if (arguments.training.min_samples < 2) throw InputError("--min-samples must be at least 2");
}

std::vector<std::uint64_t> parseSeeds(const std::string& text) {
  const auto ends = split(text, '-');
  const auto first = parseInteger(ends.front());
  const auto last = parseInteger(ends.back());
  if (ends.size() > 2 || !first || !last || *first < 0 || *last < *first || *last - *first > 9999) {
    throw InputError("--seeds " + text + ": a whole number or a range like 1-5 was expected");
  }
  std::vector<std::uint64_t> seeds;
  for (auto seed = *first; seed <= *last; ++seed) seeds.push_back(static_cast<std::uint64_t>(seed));
  return seeds;
}

std::vector<LabelledDrive> makeDrives(const Arguments& arguments) {
  std::vector<Setting> overrides;
  for (const std::string& text : arguments.settings) overrides.push_back(parseOverride(text));
  SystemConfig config = loadSystemConfig(arguments.config, overrides);
  config.slam.back_end.evaluator.check_all = true;  // there may be no tree yet
  const ClassTable classes = loadClassTable(config, std::filesystem::path(arguments.config).parent_path().string());
  const auto seeds = parseSeeds(arguments.seeds);
  const std::size_t all = arguments.scenarios.size() * seeds.size() + arguments.datasets.size();
  Progress progress("drives");
  std::vector<LabelledDrive> drives;
  for (const std::string& scenario : arguments.scenarios) {
    for (const std::uint64_t seed : seeds) {
      drives.push_back(simulateLabelledDrive(scenario, seed, config.slam, classes));
      progress(drives.size(), all);
    }
  }
  for (const std::string& folder : arguments.datasets) {
    DatasetFiles files = arguments.files;
    files.folder = folder;
    drives.push_back(readLabelledDrive(files, config.slam, classes));
    progress(drives.size(), all);
  }
  return drives;
}

// "town 1-5, opposite_direction 1-5", for the file and the eye.
std::string describeDrives(const Arguments& arguments, const ChoiceScore& score) {
  std::vector<std::string> names;
  for (const std::string& scenario : arguments.scenarios) {
    names.push_back("simulated " + std::filesystem::path(scenario).stem().string() + ", seeds " + arguments.seeds);
  }
  for (const std::string& folder : arguments.datasets) names.push_back("recorded " + folder);
  return joined(names, "; ") + ": " + std::to_string(score.submaps) + " submaps, " + std::to_string(score.revisits) +
         " revisits, " + std::to_string(score.good) + " recognisable";
}

void print(const std::string& title, const ChoiceScore& score) {
  std::printf("%s: precision %.3f, recall %.3f (of all revisits %.3f), %.1f %% of the submaps skipped\n", title.c_str(),
              score.precision(), score.recall(), score.revisitRecall(), 100.0 * score.skipped());
}

void printEach(const std::vector<LabelledDrive>& drives, const SubmapClassifier& classifier) {
  for (const LabelledDrive& drive : drives) {
    const ChoiceScore score = scoreChoice({drive}, classifier);
    std::printf("%-28s %4d submaps, %3d skipped; %3d recognisable revisits, %d lost\n", drive.name.c_str(),
                score.submaps, score.submaps - score.chosen, score.good, score.good - score.chosen_good);
  }
}

int run(int argc, char** argv) {
  Arguments arguments;
  if (!parseOrHelp({argv + 1, argv + argc}, kUsage, makeOptions(arguments))) return 0;
  requireUsable(arguments);
  if (!arguments.test.empty()) {
    const SubmapClassifier classifier = SubmapClassifier::load(arguments.test);
    const auto drives = makeDrives(arguments);
    printEach(drives, classifier);
    const ChoiceScore score = scoreChoice(drives, classifier);
    print("tested on " + describeDrives(arguments, score), score);
    return 0;
  }
  requireReplaceable(arguments.output);
  const auto drives = makeDrives(arguments);
  const CrossValidation validation = crossValidate(drives, arguments.training, arguments.recall);
  SubmapClassifier classifier = trainOn(drives, arguments.training);
  classifier.setMinProb(validation.min_prob);
  const std::string trained_on = describeDrives(arguments, validation.score);
  writeFileAtomically(arguments.output, classifier.toYaml(trained_on));
  std::printf("trained on %s\n", trained_on.c_str());
  print("cross-validated", validation.score);
  print("on the training drives", scoreChoice(drives, classifier));
  std::printf("min_prob %.4f; tree in %s\n", validation.min_prob, arguments.output.c_str());
  return 0;
}

}  // namespace
}  // namespace semantic_mht_slam

int main(int argc, char** argv) {
  return semantic_mht_slam::runProgram("train_submap_evaluator", [&] { return semantic_mht_slam::run(argc, argv); });
}
