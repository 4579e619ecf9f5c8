#include <algorithm>
#include <iostream>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "semantic_mht_slam/app/system_config.h"
#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/io/text_file.h"

#include "evaluate_benchmark_cells.h"
#include "evaluate_benchmark_report.h"
#include "evaluate_benchmark_runner.h"
#include "evaluate_benchmark_scores.h"
#include "evaluate_commands.h"
#include "program.h"
#include "progress.h"

namespace semantic_mht_slam {
namespace {

namespace po = boost::program_options;

constexpr int kMaxJobs = 1024;

std::string usage() {
  std::string text =
      "Runs slam_offline on sequences x odometries x objects x methods x seeds, several at once, and compares the\n"
      "results with the truth, the odometry as it is and other systems. What is complete is not run again.\n"
      "\n"
      "usage: evaluate benchmark --data DIR --output DIR [--sequences 00,05] [--odometries vo_orb,..]\n"
      "           [--objects best,noisy] [--methods dpmhm,..] [--seeds 1-5] [--jobs N] [--set KEY=VALUE ...]\n"
      "\n"
      "  DIR/NN/  times.txt, calib.txt, poses.txt, odometry/*.txt, objects, and for comparison reference/*.txt\n"
      "  objects  best: objects.csv, else objects_semireal.csv; semireal; noisy; or the name of a file in DIR/NN\n"
      "  output   report.html, results.csv, results.json, results.md, times.csv, config.yaml, runs/\n"
      "\n"
      "methods\n";
  for (const BenchmarkMethod& method : benchmarkMethods()) {
    text += "  " + method.name + std::string(19 - std::min<std::size_t>(18, method.name.size()), ' ') + method.help +
            (method.is_default ? "" : " (only if named)") + "\n";
  }
  return text;
}

int cores() {
  return std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, kMaxJobs);
}

/// The command line; false if only help was asked for.
bool parse(const std::vector<std::string>& arguments, BenchmarkRequest& request) {
  std::string sequences;
  std::string odometries;
  std::string objects = "best";
  std::string methods;
  std::string seeds = "1-5";
  po::options_description options("options");
  options.add_options()("data", po::value(&request.data)->required(), "folder with a folder a sequence")(
      "output", po::value(&request.output)->required(), "folder for the report and the runs")(
      "sequences", po::value(&sequences), "default: every folder that has times.txt and poses.txt")(
      "odometries", po::value(&odometries), "names of files odometry/NAME.txt; default: all")(
      "objects", po::value(&objects), "default: best")("methods", po::value(&methods), "default: all but one")(
      "seeds", po::value(&seeds), "default: 1-5")("jobs", po::value(&request.jobs)->default_value(cores()),
                                                  "runs at once; default: one a core")(
      "set", po::value(&request.settings)->composing(), "KEY=VALUE, changes a parameter of every run")(
      "config", po::value(&request.config)->default_value(packageConfigFile("kitti.yaml")), "parameters");
  if (!parseOrHelp(arguments, usage(), options)) return false;
  if (!sequences.empty()) request.sequences = parseNames("--sequences", sequences);
  if (!odometries.empty()) request.odometries = parseNames("--odometries", odometries);
  if (!methods.empty()) request.methods = parseNames("--methods", methods);
  request.objects = parseNames("--objects", objects);
  request.seeds = parseSeeds(seeds);
  if (request.jobs < 1 || request.jobs > kMaxJobs) {
    throw InputError("--jobs " + std::to_string(request.jobs) + ": 1 to " + std::to_string(kMaxJobs) +
                     " were expected");
  }
  return true;
}

/// Scores what ran; a result that cannot be scored is a failure of its cell. Returns how many there were.
std::size_t scoreCells(std::vector<BenchmarkCell>& cells) {
  BenchmarkScorer scorer;
  Progress progress("scores");
  std::size_t failed = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    progress(i, cells.size());
    BenchmarkCell& cell = cells[i];
    if (!cell.run.failure.empty()) continue;
    try {
      cell.run.figures = scorer.figuresOf(cell);
    } catch (const InputError& problem) {
      cell.run.failure = problem.what();
      printProblem("evaluate", nameOf(cell) + " cannot be scored: " + problem.what());
      ++failed;
    }
  }
  return failed;
}

std::vector<BenchmarkReference> scoreReferences(const std::vector<BenchmarkCell>& cells) {
  std::vector<BenchmarkReference> references;
  std::set<std::string> done;
  for (const BenchmarkCell& cell : cells) {
    if (!done.insert(cell.run.sequence).second) continue;
    const SequenceTruth truth = readTruth(cell.dataset);
    for (const auto& [name, poses] : readReferences(cell.dataset, truth)) {
      references.push_back({cell.run.sequence, name, trajectoryError(truth.T_world_cam0, poses),
                            frameErrors(truth.T_world_cam0, poses).running_rmse_m});
    }
  }
  return references;
}

}  // namespace

int evaluateBenchmark(const std::vector<std::string>& arguments) {
  BenchmarkResult result;
  if (!parse(arguments, result.request)) return 0;
  result.cells = makeCells(result.request);
  std::vector<std::string> settings = result.request.settings;
  settings.emplace_back("method=dpmhm");
  result.config = effectiveConfig(result.request.config, settings);
  result.program = programHash();
  prepareOutputFolder(result.request.output);
  const RunCounts counts = runCells(result.request, result.cells);
  const std::size_t not_scored = scoreCells(result.cells);
  result.references = scoreReferences(result.cells);
  writeBenchmark(result);
  for (const Statement& statement : benchmarkStatements(runsOf(result))) {
    std::cout << (statement.holds ? "yes  " : "NO   ") << statement.text << "\n";
  }
  std::cout << counts.made << " runs made, " << counts.found << " found complete, " << counts.failed + not_scored
            << " failed; report in " << result.request.output << "/report.html\n";
  return counts.failed + not_scored == 0 ? 0 : 1;
}

}  // namespace semantic_mht_slam
