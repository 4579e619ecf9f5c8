#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "semantic_mht_slam/evaluation/benchmark_table.h"

namespace semantic_mht_slam {

/// A column of the benchmark: a method of `slam_offline`, possibly with a part switched off.
struct BenchmarkMethod {
  std::string name;
  std::string method;                 ///< value of the key `method`
  std::vector<std::string> settings;  ///< KEY=VALUE
  std::string color;                  ///< SVG colour, the same in every plot
  bool is_default = true;             ///< runs unless methods are named
  bool uses_seed = true;              ///< false: one run with the first seed
  std::string help;
};

/// Every method, in the order of the report.
const std::vector<BenchmarkMethod>& benchmarkMethods();

/// The command line of `evaluate benchmark`.
struct BenchmarkRequest {
  std::string data;
  std::string output;
  std::vector<std::string> sequences;   ///< empty: every folder of `data` with times.txt and poses.txt
  std::vector<std::string> odometries;  ///< empty: every file of the folder odometry of a sequence
  std::vector<std::string> objects = {"best"};
  std::vector<std::string> methods;  ///< empty: the default ones
  std::vector<std::uint64_t> seeds = {1, 2, 3, 4, 5};
  std::vector<std::string> settings;  ///< KEY=VALUE, for every run
  std::string config;
  int jobs = 1;
};

/// One run of the benchmark: what it is, and the files it needs.
struct BenchmarkCell {
  BenchmarkRun run;  ///< without figures
  const BenchmarkMethod* method = nullptr;
  std::string dataset;       ///< folder of the sequence
  std::string objects_file;  ///< in `dataset`
  std::string folder;        ///< of its results; cells that are the same run share it
};

/// "00 vo_orb objects dpmhm seed 3".
std::string nameOf(const BenchmarkCell& cell);

/// Every cell of a benchmark: sequences, odometries, objects, methods, seeds, the last one fastest.
/// Throws InputError for names that do not exist and files that are missing.
std::vector<BenchmarkCell> makeCells(const BenchmarkRequest& request);

/// The odometry file of a cell or of another trajectory of its sequence, relative to its dataset.
std::string odometryFile(const std::string& odometry);

/// Parts of a list "a,b,c". Throws InputError for an empty part.
std::vector<std::string> parseNames(const std::string& option, const std::string& text);

/// Seeds of a list "1-5,9". Throws InputError.
std::vector<std::uint64_t> parseSeeds(const std::string& text);

}  // namespace semantic_mht_slam
