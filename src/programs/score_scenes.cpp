#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "semantic_mht_slam/app/system_config.h"
#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/common/text.h"
#include "semantic_mht_slam/io/calibration_file.h"
#include "semantic_mht_slam/io/csv_file.h"
#include "semantic_mht_slam/io/dataset.h"
#include "semantic_mht_slam/io/objects_file.h"
#include "semantic_mht_slam/io/text_file.h"
#include "semantic_mht_slam/io/trajectory_file.h"
#include "semantic_mht_slam/place/scene_accumulation.h"
#include "semantic_mht_slam/place/scene_alignment.h"

#include "program.h"

namespace po = boost::program_options;
namespace fs = std::filesystem;

namespace semantic_mht_slam {
namespace {

constexpr const char* kUsage =
    "How alike the places of two frames are, from the objects of these two frames alone: the squared soft number of\n"
    "objects that lie on each other under the best rigid motion, over the number of objects in the smaller frame.\n"
    "\n"
    "usage: score_scenes --dataset DIR --pairs pairs.csv --output scores.csv [--config FILE] [--objects FILE]\n"
    "                    [--window N --odometry FILE] [--set KEY=VALUE ...]\n"
    "\n"
    "  pairs.csv   columns i,j: rows of the data set's times.txt\n"
    "  scores.csv  columns i,j,score: the same rows; larger is more alike; 0: nothing in common\n";

struct Arguments {
  std::string config = packageConfigFile("kitti.yaml");
  std::string dataset;
  std::string objects = "objects.csv";
  std::string pairs;
  std::string output;
  std::string odometry;
  int window = 0;
  std::vector<std::string> settings;
};

po::options_description makeOptions(Arguments& arguments) {
  po::options_description options("Options");
  auto add = options.add_options();
  add("config", po::value(&arguments.config)->value_name("FILE"), "default: the package's kitti.yaml");
  add("dataset", po::value(&arguments.dataset)->value_name("DIR")->required(), "folder with times.txt");
  add("objects", po::value(&arguments.objects)->value_name("FILE"),
      "objects CSV; default: objects.csv of the data set");
  add("pairs", po::value(&arguments.pairs)->value_name("FILE")->required(), "CSV i,j");
  add("output", po::value(&arguments.output)->value_name("FILE")->required(), "CSV i,j,score");
  add("window", po::value(&arguments.window)->value_name("N"),
      "adds the objects of the N frames before each; needs --odometry; default: 0");
  add("odometry", po::value(&arguments.odometry)->value_name("FILE"),
      "KITTI trajectory by which these frames are moved");
  add("set", po::value(&arguments.settings)->value_name("KEY=VALUE")->composing(),
      "changes a key of the configuration");
  return options;
}

/// A file of the data set, or of the current folder.
std::string locate(const std::string& folder, const std::string& file) {
  const fs::path inside = fs::path(folder) / file;
  return fs::exists(inside) ? inside.string() : file;
}

using FramePairs = std::vector<std::pair<std::size_t, std::size_t>>;

FramePairs readPairs(const std::string& path, std::size_t frames) {
  FramePairs pairs;
  const auto frameOf = [frames](const CsvRow& row, std::size_t column) {
    const std::int64_t frame = row.integer(column);
    if (frame < 0 || frame >= static_cast<std::int64_t>(frames)) {
      row.fail(column, "there is no frame " + std::to_string(frame) + ", the data set has " + std::to_string(frames));
    }
    return static_cast<std::size_t>(frame);
  };
  CsvReader({"i", "j"}).read(path, [&](const CsvRow& row) { pairs.emplace_back(frameOf(row, 0), frameOf(row, 1)); });
  return pairs;
}

std::vector<Pose> readOdometry(const Arguments& arguments, std::size_t frames) {
  const Pose T_cam0_base = readCalibration(locate(arguments.dataset, "calib.txt"));
  const std::string path = locate(arguments.dataset, arguments.odometry);
  std::vector<Pose> T_odom_base;
  for (const Pose& T_world_cam0 : readKittiTrajectory(path)) T_odom_base.push_back(toBase(T_world_cam0, T_cam0_base));
  if (T_odom_base.size() != frames) {
    throw InputError(path + ": " + std::to_string(T_odom_base.size()) + " poses, times.txt has " +
                     std::to_string(frames) + " rows");
  }
  return T_odom_base;
}

/// Scenes of frames, prepared when they are first asked for.
class Scenes {
 public:
  Scenes(std::vector<Detections> detections, std::vector<Pose> T_odom_base, int window, const ClassTable& classes,
         double noise_floor_m)
      : detections_(std::move(detections)),
        T_odom_base_(std::move(T_odom_base)),
        window_(window),
        classes_(classes),
        noise_floor_m_(noise_floor_m),
        prepared_(detections_.size()) {}

  const PlanarScene& of(std::size_t frame) {
    if (!prepared_[frame]) prepared_[frame] = makePlanarScene(sceneAt(frame), classes_, noise_floor_m_);
    return *prepared_[frame];
  }

 private:
  Scene sceneAt(std::size_t frame) const {
    if (window_ == 0) return sceneOfFrame(detections_[frame], classes_);
    std::vector<Detections> frames;
    std::vector<Pose> T_base_frame;
    for (std::size_t i = frame - std::min<std::size_t>(frame, window_); i <= frame; ++i) {
      frames.push_back(detections_[i]);
      T_base_frame.push_back(T_odom_base_[frame].inverse() * T_odom_base_[i]);
    }
    return accumulateScene(frames, T_base_frame, classes_);
  }

  std::vector<Detections> detections_;
  std::vector<Pose> T_odom_base_;
  int window_;
  const ClassTable& classes_;
  double noise_floor_m_;
  std::vector<std::optional<PlanarScene>> prepared_;
};

void checkArguments(const Arguments& arguments) {
  if (arguments.window < 0) throw InputError("--window must not be negative");
  if ((arguments.window > 0) != !arguments.odometry.empty()) {
    throw InputError("--window and --odometry belong together");
  }
}

int run(const Arguments& arguments) {
  checkArguments(arguments);
  std::vector<Setting> settings;
  for (const std::string& text : arguments.settings) settings.push_back(parseOverride(text));
  const SystemConfig config = loadSystemConfig(arguments.config, settings);
  const ClassTable classes = loadClassTable(config, fs::path(arguments.config).parent_path().string());
  const std::size_t frames = readTimes(locate(arguments.dataset, "times.txt")).size();
  const FramePairs pairs = readPairs(arguments.pairs, frames);
  std::vector<Pose> T_odom_base;
  if (arguments.window > 0) T_odom_base = readOdometry(arguments, frames);
  const SceneAlignmentConfig& alignment = config.slam.back_end.place.alignment;
  Scenes scenes(readObjects(locate(arguments.dataset, arguments.objects), classes, frames), std::move(T_odom_base),
                arguments.window, classes, alignment.noise_floor_m);
  std::string text = "i,j,score\n";
  for (const auto& [i, j] : pairs) {
    const std::vector<SceneAlignment> found = alignScenes(scenes.of(i), scenes.of(j), classes, alignment);
    const double score = found.empty() ? 0.0 : found.front().similarity;
    text += std::to_string(i) + "," + std::to_string(j) + "," + formatDouble(score) + "\n";
  }
  writeFileAtomically(arguments.output, text);
  return 0;
}

}  // namespace
}  // namespace semantic_mht_slam

int main(int argc, char** argv) {
  using namespace semantic_mht_slam;
  return runProgram("score_scenes", [&] {
    Arguments arguments;
    const std::vector<std::string> words(argv + 1, argv + argc);
    return parseOrHelp(words, kUsage, makeOptions(arguments)) ? run(arguments) : 0;
  });
}
