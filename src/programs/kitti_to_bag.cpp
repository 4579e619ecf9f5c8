#include <cstdio>
#include <string>
#include <utility>

#include <boost/program_options.hpp>

#include "semantic_mht_slam/app/labelled_classes.h"
#include "semantic_mht_slam/app/labelled_scans.h"
#include "semantic_mht_slam/app/recording.h"
#include "semantic_mht_slam/app/system_config.h"
#include "semantic_mht_slam/bags/bag_file.h"
#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/io/dataset.h"

#include "program.h"
#include "progress.h"

namespace po = boost::program_options;

namespace semantic_mht_slam {
namespace {

constexpr const char* kUsage =
    "Makes a bag of a data-set folder: objects, odometry, tf and, where poses.txt is there, ground truth. Objects "
    "come\n"
    "from a CSV, or are extracted from velodyne/NNNNNN.bin and labels/NNNNNN.label (SemanticKITTI's format).\n"
    "  kitti_to_bag --dataset DIR [--objects FILE] [--odometry FILE] --output FILE.bag\n";

struct Arguments {
  DatasetFiles dataset;
  std::string objects;
  std::string classes = "classes_semantic_kitti.yaml";
  std::string extraction;
  std::string output;
  double start_s = 1.0;
};

po::options_description makeOptions(Arguments& arguments) {
  po::options_description options("Options");
  auto add = options.add_options();
  add("dataset", po::value(&arguments.dataset.folder)->value_name("DIR"), "folder with times.txt, calib.txt, ...");
  add("objects", po::value(&arguments.objects)->value_name("FILE"),
      "objects CSV; default: extracted where there are velodyne/ and labels/, else objects.csv");
  add("odometry", po::value(&arguments.dataset.odometry)->value_name("FILE"),
      "odometry in KITTI format; default: odometry/vo_orb.txt");
  add("classes", po::value(&arguments.classes)->value_name("FILE"),
      "class table or label map; default: SemanticKITTI's table and raw label ids");
  add("extraction", po::value(&arguments.extraction)->value_name("FILE"), "parameters of the extraction, YAML");
  add("start", po::value(&arguments.start_s)->value_name("SECONDS"),
      "ROS time of the data set's time 0, above 0; default: 1");
  add("output", po::value(&arguments.output)->value_name("FILE"), "the bag");
  return options;
}

/// The folder's drive with the objects of the CSV or of the labelled scans.
Recording readRecording(const Arguments& arguments, const LabelledClasses& labelled) {
  DatasetFiles files = arguments.dataset;
  const bool is_extracted = arguments.objects.empty() && hasLabelledScans(files.folder);
  if (is_extracted) files.objects.clear();
  if (!arguments.objects.empty()) files.objects = arguments.objects;
  Dataset dataset = readDataset(files, labelled.classes);
  printNotice("kitti_to_bag", dataset.notice);
  Recording recording = toRecording(std::move(dataset));
  if (!is_extracted) return recording;
  const ExtractionConfig config = loadExtractionConfig(labelled.classes, arguments.extraction, {});
  Progress progress("kitti_to_bag: scan");
  ExtractedScans scans = extractScans(files.folder, recording.odometry, labelled, config,
                                      [&](std::size_t done, std::size_t all) { progress(done, all); });
  for (const std::string& problem : scans.problems) printProblem("kitti_to_bag", problem);
  if (scans.without_scan > 0) {
    printProblem("kitti_to_bag", files.folder + ": " + std::to_string(scans.without_scan) +
                                     " frames without scan or labels have no objects");
  }
  recording.detector_frames = std::move(scans.frames);
  return recording;
}

int run(int argc, char** argv) {
  Arguments arguments;
  if (!parseOrHelp({argv + 1, argv + argc}, kUsage, makeOptions(arguments))) return 0;
  if (arguments.dataset.folder.empty()) throw InputError("--dataset is needed");
  if (arguments.output.empty()) throw InputError("--output is needed");
  if (!(arguments.start_s > 0.0 && arguments.start_s < 4e9))
    throw InputError("--start must be above 0 and below 4e9 s");

  const LabelledClasses labelled = loadLabelledClasses(arguments.classes);
  const Recording recording = readRecording(arguments, labelled);
  writeBag(arguments.output, recording, labelled.classes, NodeConfig{}, BagLayout{},
           stampFromSeconds(arguments.start_s));
  std::size_t objects = 0;
  for (const DetectorFrame& frame : recording.detector_frames) objects += frame.detections.size();
  std::printf("%zu frames and %zu objects in %s\n", recording.odometry.size(), objects, arguments.output.c_str());
  return 0;
}

}  // namespace
}  // namespace semantic_mht_slam

int main(int argc, char** argv) {
  return semantic_mht_slam::runProgram("kitti_to_bag", [&] { return semantic_mht_slam::run(argc, argv); });
}
