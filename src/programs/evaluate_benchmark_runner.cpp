#include "evaluate_benchmark_runner.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <map>

#include <unistd.h>

#include "semantic_mht_slam/app/system_config.h"
#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/common/text.h"
#include "semantic_mht_slam/io/text_file.h"

#include "evaluate_child_processes.h"

namespace semantic_mht_slam {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr const char* kKeyFile = "benchmark_key.txt";
constexpr const char* kLogFile = "log.txt";

/// FNV-1a, 64 bits.
class Hash {
 public:
  void add(std::string_view text) {
    for (const char c : text) {
      value_ ^= static_cast<unsigned char>(c);
      value_ *= 1099511628211U;
    }
  }
  std::string text() const {
    char digits[17];
    std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(value_));
    return digits;
  }

 private:
  std::uint64_t value_ = 14695981039346656037U;
};

std::string hashOfFile(const std::string& path) {
  Hash hash;
  hash.add(readFile(path));
  return hash.text();
}

fs::path programFolder() {
  return fs::read_symlink("/proc/self/exe").parent_path();
}

std::string slamOffline() {
  const fs::path program = programFolder() / "slam_offline";
  if (!fs::exists(program)) throw InputError("no program '" + program.string() + "', which the benchmark runs");
  return program.string();
}

std::vector<std::string> settingsOf(const BenchmarkRequest& request, const BenchmarkCell& cell) {
  std::vector<std::string> settings = request.settings;
  settings.insert(settings.end(), cell.method->settings.begin(), cell.method->settings.end());
  return settings;
}

/// Everything that a run's result depends on, as text; a result beside the same text is not made again.
class KeyMaker {
 public:
  explicit KeyMaker(const BenchmarkRequest& request) : request_(request), program_(programHash()) {}

  std::string keyOf(const BenchmarkCell& cell) {
    std::vector<std::string> settings = settingsOf(request_, cell);
    settings.push_back("method=" + cell.method->method);
    settings.push_back("seed=" + std::to_string(cell.run.seed));
    std::string key = "program " + program_ + "\n";
    for (const std::string& name : {std::string("times.txt"), std::string("calib.txt"), std::string("poses.txt"),
                                    cell.objects_file, odometryFile(cell.run.odometry)}) {
      key += name + " " + hashOf(cell.dataset + "/" + name) + "\n";
    }
    key += "classes " + hashOf(classTable()) + "\n";
    if (const std::string tree = evaluatorTree(settings); !tree.empty()) key += "tree " + hashOf(tree) + "\n";
    return key + effectiveConfig(request_.config, settings);
  }

 private:
  const std::string& hashOf(const std::string& path) {
    std::string& hash = hashes_[path];
    if (hash.empty()) hash = hashOfFile(path);
    return hash;
  }

  std::string classTable() const {
    const SystemConfig config = loadSystemConfig(request_.config, {});
    const std::string located = locateClassTable(config, fs::path(request_.config).parent_path().string());
    return fs::path(located).is_absolute() ? located : packageConfigFile(located);
  }

  /// Empty if every submap is checked.
  std::string evaluatorTree(const std::vector<std::string>& settings) const {
    std::vector<Setting> overrides;
    for (const std::string& text : settings) overrides.push_back(parseOverride(text));
    const SystemConfig config = loadSystemConfig(request_.config, overrides);
    if (config.slam.back_end.evaluator.check_all) return "";
    const std::string folder = fs::path(request_.config).parent_path().string();
    return loadableSlamConfig(config, folder).back_end.evaluator.tree;
  }

  const BenchmarkRequest& request_;
  const std::string program_;
  std::map<std::string, std::string> hashes_;
};

bool isComplete(const BenchmarkCell& cell, const std::string& key) {
  const fs::path folder(cell.folder);
  return fs::exists(folder / "report.json") && fs::exists(folder / kKeyFile) &&
         readFile((folder / kKeyFile).string()) == key;
}

ChildProcess processOf(const BenchmarkRequest& request, const BenchmarkCell& cell, const std::string& program) {
  ChildProcess process;
  process.command = {program,
                     "--config",
                     request.config,
                     "--dataset",
                     cell.dataset,
                     "--objects",
                     cell.objects_file,
                     "--odometry",
                     odometryFile(cell.run.odometry),
                     "--method",
                     cell.method->method,
                     "--seed",
                     std::to_string(cell.run.seed)};
  for (const std::string& setting : settingsOf(request, cell)) {
    process.command.insert(process.command.end(), {"--set", setting});
  }
  process.command.insert(process.command.end(), {"--output", cell.folder});
  process.log_path = (fs::path(cell.folder) / kLogFile).string();
  return process;
}

std::string lastLine(const std::string& text) {
  std::string last;
  forEachLine(text, [&](int, std::string_view line) { last = line; });
  return last;
}

std::string failureOf(const ChildProcess& process, int code) {
  std::error_code error;
  const std::string said = fs::exists(process.log_path, error) ? lastLine(readFile(process.log_path)) : "";
  const std::string reason = code > 128 ? "signal " + std::to_string(code - 128) : "code " + std::to_string(code);
  return said.empty() ? reason : reason + ": " + said;
}

/// Runs done, and the time left by the frames that are left. On a terminal in place, elsewhere a line every 10 s.
class BenchmarkProgress {
 public:
  BenchmarkProgress(std::size_t runs, double frames) : runs_(runs), frames_(frames) {}
  ~BenchmarkProgress() {
    if (is_terminal_ && has_printed_) std::fputc('\n', stderr);
  }
  BenchmarkProgress(const BenchmarkProgress&) = delete;
  BenchmarkProgress& operator=(const BenchmarkProgress&) = delete;

  void add(double frames) {
    ++done_;
    done_frames_ += frames;
    const Clock::time_point now = Clock::now();
    if (done_ < runs_ && now - printed_ < std::chrono::seconds(is_terminal_ ? 1 : 10)) return;
    printed_ = now;
    has_printed_ = true;
    const double seconds = std::chrono::duration<double>(now - begin_).count();
    const double left_s = seconds * (frames_ - done_frames_) / done_frames_;
    std::fprintf(stderr, "%sruns %zu/%zu, about %.0f min %02d s left%s", is_terminal_ ? "\r" : "", done_, runs_,
                 std::floor(left_s / 60.0), static_cast<int>(std::fmod(left_s, 60.0)), is_terminal_ ? "  " : "\n");
  }

  /// A message on a line of its own.
  void tell(const std::string& message) {
    std::fprintf(stderr, "%s%s\n", is_terminal_ && has_printed_ ? "\n" : "", message.c_str());
  }

 private:
  const std::size_t runs_;
  const double frames_;
  const bool is_terminal_ = ::isatty(2) != 0;
  const Clock::time_point begin_ = Clock::now();
  Clock::time_point printed_ = begin_;
  bool has_printed_ = false;
  std::size_t done_ = 0;
  double done_frames_ = 0.0;
};

/// A run that is to be made, for the first of the cells that share its folder.
struct PlannedRun {
  std::size_t cell = 0;
  std::string key;
  double frames = 0.0;
};

double framesOf(const BenchmarkCell& cell) {
  const std::string times = readFile(cell.dataset + "/times.txt");
  return static_cast<double>(std::count(times.begin(), times.end(), '\n'));
}

std::vector<PlannedRun> plan(const BenchmarkRequest& request, const std::vector<BenchmarkCell>& cells,
                             RunCounts& counts) {
  KeyMaker keys(request);
  std::map<std::string, std::size_t> seen;
  std::vector<PlannedRun> planned;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (!seen.emplace(cells[i].folder, i).second) continue;
    std::string key = keys.keyOf(cells[i]);
    if (isComplete(cells[i], key)) {
      ++counts.found;
    } else {
      planned.push_back({i, std::move(key), framesOf(cells[i])});
    }
  }
  return planned;
}

std::vector<ChildProcess> prepare(const BenchmarkRequest& request, const std::vector<BenchmarkCell>& cells,
                                  const std::vector<PlannedRun>& planned) {
  const std::string program = slamOffline();
  std::vector<ChildProcess> processes;
  for (const PlannedRun& run : planned) {
    fs::remove_all(cells[run.cell].folder);  // what an older program wrote must not be taken for this one's result
    prepareOutputFolder(cells[run.cell].folder);
    processes.push_back(processOf(request, cells[run.cell], program));
  }
  return processes;
}

}  // namespace

RunCounts runCells(const BenchmarkRequest& request, std::vector<BenchmarkCell>& cells) {
  RunCounts counts;
  const std::vector<PlannedRun> planned = plan(request, cells, counts);
  const std::vector<ChildProcess> processes = prepare(request, cells, planned);
  double frames = 0.0;
  for (const PlannedRun& run : planned) frames += run.frames;
  BenchmarkProgress progress(planned.size(), frames);
  runChildProcesses(processes, request.jobs, [&](std::size_t index, int code) {
    const BenchmarkCell& cell = cells[planned[index].cell];
    ++counts.made;
    progress.add(planned[index].frames);
    if (code == 0) {
      writeFileAtomically((fs::path(cell.folder) / kKeyFile).string(), planned[index].key);
      return;
    }
    ++counts.failed;
    const std::string failure = failureOf(processes[index], code);
    progress.tell("evaluate: " + nameOf(cell) + " failed, " + failure);
    for (BenchmarkCell& other : cells) {
      if (other.folder == cell.folder) other.run.failure = failure;
    }
  });
  return counts;
}

std::string effectiveConfig(const std::string& config, const std::vector<std::string>& settings) {
  std::vector<Setting> overrides;
  for (const std::string& text : settings) overrides.push_back(parseOverride(text));
  return toYaml(loadSystemConfig(config, overrides));
}

std::string programHash() {
  std::vector<fs::path> files = {slamOffline()};
  for (const fs::directory_entry& entry : fs::directory_iterator(programFolder().parent_path())) {
    const std::string name = entry.path().filename().string();
    // The benchmark scores the runs itself: another way of scoring does not make a run another one.
    const bool is_own = name.rfind("libsemantic_mht_slam_", 0) == 0 && name.find("_evaluation.") == std::string::npos;
    if (is_own && entry.is_regular_file()) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  Hash hash;
  for (const fs::path& file : files) hash.add(readFile(file.string()));
  return hash.text();
}

}  // namespace semantic_mht_slam
