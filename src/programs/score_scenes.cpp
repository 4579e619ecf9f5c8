#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "semantic_mht_slam/app/system_config.h"
#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/common/text.h"
#include "semantic_mht_slam/io/calibration_file.h"
#include "semantic_mht_slam/io/csv_file.h"
#include "semantic_mht_slam/io/dataset.h"
#include "semantic_mht_slam/io/existing_path.h"
#include "semantic_mht_slam/io/objects_file.h"
#include "semantic_mht_slam/io/text_file.h"
#include "semantic_mht_slam/io/trajectory_file.h"
#include "semantic_mht_slam/models/odometry_model.h"
#include "semantic_mht_slam/models/usable_detection.h"
#include "semantic_mht_slam/place/laplacian.h"
#include "semantic_mht_slam/place/scene_accumulation.h"
#include "semantic_mht_slam/place/scene_alignment.h"
#include "semantic_mht_slam/place/scene_score.h"

#include "program.h"

namespace po = boost::program_options;
namespace fs = std::filesystem;

namespace semantic_mht_slam {
namespace {

constexpr const char* kUsage =
    "How alike the places of two frames are, from the objects of these two frames alone: the squared soft number of\n"
    "objects that lie on each other under the best rigid motion, over the number of objects in the smaller frame; or,\n"
    "with --chain paper, the sum of the paper's topology and landmark score.\n"
    "\n"
    "usage: score_scenes --dataset DIR --pairs pairs.csv --output scores.csv [--config FILE] [--objects FILE]\n"
    "                    [--chain default|paper] [--window N --odometry FILE] [--set KEY=VALUE ...]\n"
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
  std::string chain = "default";
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
  add("chain", po::value(&arguments.chain)->value_name("NAME"),
      "default: objects that lie on each other; paper: the scores of its section III-B");
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
  return mayExist(inside.string()) ? inside.string() : file;
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
  const auto add = [&](const CsvRow& row) { pairs.emplace_back(frameOf(row, 0), frameOf(row, 1)); };
  printNotice("score_scenes", CsvReader({"i", "j"}).read(path, add));
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

/// The objects of a frame and, if asked for, of those before it.
class Scenes {
 public:
  Scenes(std::vector<Detections> detections, std::vector<Pose> T_odom_base, int window, const ClassTable& classes)
      : detections_(std::move(detections)), T_odom_base_(std::move(T_odom_base)), window_(window), classes_(classes) {
    for (Detections& frame : detections_) removeUnusable(frame);
  }

  Scene at(std::size_t frame) const {
    if (window_ == 0) return sceneOfFrame(detections_[frame], classes_);
    std::vector<SeenFrame> frames;
    Motion since;
    for (std::size_t i = frame;; --i) {
      const Pose T_base_frame = T_odom_base_[frame].inverse() * T_odom_base_[i];
      frames.push_back({detections_[i], T_base_frame, varianceOf(OdometryNoise{}, since)});
      if (i == frame - std::min<std::size_t>(frame, window_)) break;
      since = since + motionOf(T_odom_base_[i - 1].inverse() * T_odom_base_[i]);
    }
    std::reverse(frames.begin(), frames.end());
    return accumulateScene(frames, classes_);
  }

 private:
  std::vector<Detections> detections_;
  std::vector<Pose> T_odom_base_;
  int window_;
  const ClassTable& classes_;
};

using ScoreOfPair = std::function<double(std::size_t, std::size_t)>;

/// Keeps what was made of each frame.
template <typename Prepared>
std::function<const Prepared&(std::size_t)> memoized(std::function<Prepared(std::size_t)> prepare) {
  const auto kept = std::make_shared<std::map<std::size_t, Prepared>>();
  return [kept, prepare = std::move(prepare)](std::size_t frame) -> const Prepared& {
    const auto found = kept->find(frame);
    return found != kept->end() ? found->second : kept->emplace(frame, prepare(frame)).first->second;
  };
}

ScoreOfPair alignmentScore(const Scenes& scenes, const ClassTable& classes, const SlamConfig& config) {
  const auto prepared = memoized<Scene>([&](std::size_t frame) { return scenes.at(frame); });
  return [&, prepared](std::size_t i, std::size_t j) {
    const std::vector<SceneAlignment> found =
        alignScenes(prepared(i), prepared(j), classes, config.registration, config.back_end.place);
    return found.empty() ? 0.0 : found.front().similarity;
  };
}

struct PaperScene {
  Scene scene;
  Eigen::MatrixXd laplacian;
};

ScoreOfPair paperScore(const Scenes& scenes, const ClassTable& classes, const PaperChainConfig& config) {
  const auto prepared = memoized<PaperScene>([&](std::size_t frame) {
    const Scene scene = scenes.at(frame);
    return PaperScene{scene, classLaplacian(scene, classes.size(), config.covisibility)};
  });
  return [&, prepared](std::size_t i, std::size_t j) {
    const PaperScene& a = prepared(i);
    const PaperScene& b = prepared(j);
    return laplacianCorrelation(a.laplacian, b.laplacian) + sceneScore(a.scene, b.scene, config.scene);
  };
}

void checkArguments(const Arguments& arguments) {
  if (arguments.window < 0) throw InputError("--window must not be negative");
  if ((arguments.window > 0) != !arguments.odometry.empty()) {
    throw InputError("--window and --odometry belong together");
  }
  if (arguments.chain != "default" && arguments.chain != "paper") {
    throw InputError("--chain " + arguments.chain + ": default or paper was expected");
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
  ObjectsFile objects = readObjects(locate(arguments.dataset, arguments.objects), classes, frames);
  printNotice("score_scenes", objects.notice);
  const Scenes scenes(std::move(objects.detections), std::move(T_odom_base), arguments.window, classes);
  const PlaceConfig& place = config.slam.back_end.place;
  const ScoreOfPair score = arguments.chain == "paper" ? paperScore(scenes, classes, place.paper)
                                                       : alignmentScore(scenes, classes, config.slam);
  std::string text = "i,j,score\n";
  for (const auto& [i, j] : pairs) {
    text += std::to_string(i) + "," + std::to_string(j) + "," + formatDouble(score(i, j)) + "\n";
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
