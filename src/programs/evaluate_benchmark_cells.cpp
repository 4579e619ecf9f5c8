#include "evaluate_benchmark_cells.h"

#include <algorithm>
#include <filesystem>
#include <optional>

#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/common/text.h"

namespace semantic_mht_slam {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kMaxSeeds = 10000;
constexpr const char* kRealObjects = "objects.csv";
constexpr const char* kSemirealObjects = "objects_semireal.csv";
constexpr const char* kNoisyObjects = "objects_noisy.csv";

bool isFile(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

/// Names of the entries of a folder that pass the test, sorted.
template <class Test>
std::vector<std::string> entriesOf(const std::string& folder, Test test) {
  std::error_code error;
  std::vector<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    if (test(entry.path())) names.push_back(entry.path().filename().string());
  }
  if (error) throw InputError("cannot read folder '" + folder + "': " + error.message());
  std::sort(names.begin(), names.end());
  return names;
}

std::vector<std::string> sequencesOf(const BenchmarkRequest& request) {
  if (!request.sequences.empty()) return request.sequences;
  std::vector<std::string> names = entriesOf(
      request.data, [](const fs::path& path) { return isFile(path / "times.txt") && isFile(path / "poses.txt"); });
  if (names.empty()) throw InputError(request.data + ": no folder in it has times.txt and poses.txt");
  return names;
}

std::vector<std::string> odometriesOf(const BenchmarkRequest& request, const std::string& dataset) {
  if (!request.odometries.empty()) return request.odometries;
  std::vector<std::string> names =
      entriesOf(dataset + "/odometry", [](const fs::path& path) { return path.extension() == ".txt"; });
  for (std::string& name : names) name = fs::path(name).stem().string();
  if (names.empty()) throw InputError(dataset + "/odometry: no .txt file in it");
  return names;
}

std::vector<const BenchmarkMethod*> methodsOf(const BenchmarkRequest& request) {
  std::vector<const BenchmarkMethod*> chosen;
  for (const BenchmarkMethod& method : benchmarkMethods()) {
    const bool is_named = std::count(request.methods.begin(), request.methods.end(), method.name) > 0;
    if (is_named || (request.methods.empty() && method.is_default)) chosen.push_back(&method);
  }
  std::vector<std::string> names;
  for (const BenchmarkMethod& method : benchmarkMethods()) names.push_back(method.name);
  for (const std::string& name : request.methods) {
    if (std::count(names.begin(), names.end(), name) > 0) continue;
    throw InputError("--methods " + name + ": no such method, known are " + joined(names));
  }
  return chosen;
}

std::string objectsFile(const std::string& dataset, const std::string& choice) {
  if (choice == "best") return isFile(fs::path(dataset) / kRealObjects) ? kRealObjects : kSemirealObjects;
  if (choice == "semireal") return kSemirealObjects;
  if (choice == "noisy") return kNoisyObjects;
  return choice;
}

/// What the objects of a file are. The landmark of each detection is known of objects that a simulator made, so that a
/// file of that kind beside objects.csv says that they are not real.
std::string kindOf(const std::string& dataset, const std::string& file) {
  if (file == kSemirealObjects) return "semi-real";
  if (file == kNoisyObjects) return "semi-real, noisy";
  if (file != kRealObjects) return file;
  return isFile(fs::path(dataset) / "objects_landmark.csv") ? "simulated" : "real";
}

void requireFiles(const BenchmarkCell& cell) {
  for (const std::string& name : {std::string("times.txt"), std::string("calib.txt"), std::string("poses.txt"),
                                  cell.objects_file, odometryFile(cell.run.odometry)}) {
    if (!isFile(fs::path(cell.dataset) / name)) throw InputError("no file '" + cell.dataset + "/" + name + "'");
  }
}

/// The name of a file as one part of a path.
std::string folderName(const std::string& file) {
  std::string name = fs::path(file).replace_extension().string();
  std::replace(name.begin(), name.end(), '/', '_');
  return name;
}

void addRuns(const BenchmarkRequest& request, BenchmarkCell cell, std::vector<BenchmarkCell>& cells) {
  requireFiles(cell);
  const fs::path folder =
      fs::path(request.output) / "runs" / cell.run.sequence / cell.run.odometry / folderName(cell.objects_file);
  for (const BenchmarkMethod* method : methodsOf(request)) {
    cell.method = method;
    cell.run.method = method->name;
    for (const std::uint64_t seed : request.seeds) {
      cell.run.seed = seed;
      cell.folder = (folder / method->name / ("seed_" + std::to_string(seed))).string();
      cells.push_back(cell);
      if (!method->uses_seed) break;
    }
  }
}

}  // namespace

const std::vector<BenchmarkMethod>& benchmarkMethods() {
  static const std::vector<BenchmarkMethod> methods = {
      {"odometry", "odometry", {}, "#777777", true, false, "the odometry as it is"},
      {"ukf", "ukf", {}, "#e69f00", true, true, "one hypothesis, nearest neighbours (baseline of the paper)"},
      {"mhm", "mhm", {}, "#cc79a7", true, true, "maximum likelihood multiple hypotheses (baseline of the paper)"},
      {"dpmhm", "dpmhm", {}, "#0072b2", true, true, "the full system"},
      {"no_semantics", "dpmhm", {"semantics=false"}, "#009e73", true, true, "dpmhm, all classes count as one"},
      {"single_hypothesis", "dpmhm", {"max_hypotheses=1"}, "#d55e00", true, true, "dpmhm, one hypothesis"},
      {"neither",
       "dpmhm",
       {"semantics=false", "max_hypotheses=1"},
       "#56b4e9",
       false,
       true,
       "dpmhm without classes and with one hypothesis"}};
  return methods;
}

std::string nameOf(const BenchmarkCell& cell) {
  return cell.run.sequence + " " + cell.run.odometry + " " + folderName(cell.objects_file) + " " + cell.run.method +
         " seed " + std::to_string(cell.run.seed);
}

std::vector<BenchmarkCell> makeCells(const BenchmarkRequest& request) {
  std::vector<BenchmarkCell> cells;
  for (const std::string& sequence : sequencesOf(request)) {
    const std::string dataset = (fs::path(request.data) / sequence).string();
    if (!fs::is_directory(dataset)) throw InputError("no data-set folder '" + dataset + "'");
    for (const std::string& odometry : odometriesOf(request, dataset)) {
      for (const std::string& objects : request.objects) {
        BenchmarkCell cell;
        cell.dataset = dataset;
        cell.objects_file = objectsFile(dataset, objects);
        cell.run.sequence = sequence;
        cell.run.odometry = odometry;
        cell.run.objects = objects;
        cell.run.kind = kindOf(dataset, cell.objects_file);
        addRuns(request, cell, cells);
      }
    }
  }
  return cells;
}

std::string odometryFile(const std::string& odometry) {
  return "odometry/" + odometry + ".txt";
}

std::vector<std::string> parseNames(const std::string& option, const std::string& text) {
  std::vector<std::string> names;
  for (const std::string_view name : split(text, ',')) {
    if (name.empty()) throw InputError(option + " " + text + ": an empty name");
    if (std::count(names.begin(), names.end(), name) > 0) {
      throw InputError(option + " " + text + ": '" + std::string(name) + "' stands twice");
    }
    names.emplace_back(name);
  }
  return names;
}

std::vector<std::uint64_t> parseSeeds(const std::string& text) {
  std::vector<std::uint64_t> seeds;
  for (const std::string& part : parseNames("--seeds", text)) {
    const std::vector<std::string_view> ends = split(part, '-');
    const std::optional<std::int64_t> first = parseInteger(ends.front());
    const std::optional<std::int64_t> last = parseInteger(ends.back());
    if (ends.size() > 2 || !first || !last || *first < 0 || *last < *first || *last - *first >= kMaxSeeds) {
      throw InputError("--seeds " + text + ": '" + part + "' is no seed and no range as 1-5");
    }
    for (std::int64_t seed = *first; seed <= *last; ++seed) seeds.push_back(static_cast<std::uint64_t>(seed));
  }
  std::sort(seeds.begin(), seeds.end());
  seeds.erase(std::unique(seeds.begin(), seeds.end()), seeds.end());
  return seeds;
}

}  // namespace semantic_mht_slam
