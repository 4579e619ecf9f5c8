#include <cstdio>
#include <string>
#include <vector>

#include <boost/program_options.hpp>

#include "semantic_mht_slam/app/labelled_classes.h"
#include "semantic_mht_slam/app/labelled_scans.h"
#include "semantic_mht_slam/app/system_config.h"
#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/images/label_image_file.h"
#include "semantic_mht_slam/io/calibration_file.h"
#include "semantic_mht_slam/io/objects_file.h"
#include "semantic_mht_slam/io/scan_file.h"
#include "semantic_mht_slam/io/text_file.h"
#include "semantic_mht_slam/perception/cloud_extractor.h"
#include "semantic_mht_slam/perception/image_extractor.h"

#include "program.h"

namespace po = boost::program_options;

namespace semantic_mht_slam {
namespace {

constexpr const char* kUsage =
    "Extracts the objects of one scan.\n"
    "  extract_objects --scan FILE.bin --labels FILE.label [--classes FILE] --output objects.csv\n"
    "  extract_objects --scan FILE.bin --image-labels FILE.png --calib FILE [--classes FILE] --output objects.csv\n";

struct Arguments {
  std::string scan;
  std::string labels;
  std::string image_labels;
  std::string calib;
  std::string classes = "labels_semantic_kitti.yaml";
  std::string config;
  std::vector<std::string> overrides;
  std::string output;
};

po::options_description makeOptions(Arguments& arguments) {
  po::options_description options("Options");
  auto add = options.add_options();
  add("scan", po::value(&arguments.scan)->value_name("FILE"), "KITTI scan: float32 x, y, z, intensity");
  add("labels", po::value(&arguments.labels)->value_name("FILE"), "SemanticKITTI labels: uint32 a point");
  add("image-labels", po::value(&arguments.image_labels)->value_name("FILE"),
      "in place of --labels: image with a class id a pixel, 8 or 16 bit, rectified left colour camera");
  add("calib", po::value(&arguments.calib)->value_name("FILE"),
      "with --image-labels: KITTI calibration with P2 and Tr or Tr_velo_to_cam");
  add("classes", po::value(&arguments.classes)->value_name("FILE"),
      "label map or class table; default: SemanticKITTI's raw ids, labels_semantic_kitti.yaml");
  add("config", po::value(&arguments.config)->value_name("FILE"), "parameters of the extraction, YAML");
  add("set", po::value(&arguments.overrides)->value_name("KEY=VALUE")->composing(), "changes one parameter");
  add("output", po::value(&arguments.output)->value_name("FILE"), "objects CSV, all rows of frame 0");
  return options;
}

Extraction extract(const Arguments& arguments, const LabelMap& labels, const ExtractionConfig& config) {
  if (arguments.image_labels.empty()) {
    return extractObjects(readLabelledScan(arguments.scan, arguments.labels), labels, config);
  }
  const Camera camera = readCamera(arguments.calib);
  return extractObjects(readScan(arguments.scan), readLabelImage(arguments.image_labels), camera, labels, config);
}

void reportProblems(const Extraction& extraction, const Arguments& arguments) {
  const auto report = [](const std::string& file, const std::string& problem) {
    printProblem("extract_objects", file + ": " + problem);
  };
  const bool is_image = arguments.labels.empty();
  if (extraction.points == 0) report(arguments.scan, "the scan has no points");
  const std::string unknown = extraction.describeUnknownLabels(is_image ? "pixels" : "points");
  if (!unknown.empty()) report(is_image ? arguments.image_labels : arguments.labels, "skipped " + unknown);
  if (extraction.points_not_finite > 0) {
    report(arguments.scan, "skipped " + std::to_string(extraction.points_not_finite) + " points that are not finite");
  }
}

int run(int argc, char** argv) {
  Arguments arguments;
  if (!parseOrHelp({argv + 1, argv + argc}, kUsage, makeOptions(arguments))) return 0;
  if (arguments.scan.empty()) throw InputError("--scan is needed");
  if (arguments.labels.empty() == arguments.image_labels.empty()) {
    throw InputError("either --labels or --image-labels is needed");
  }
  if (arguments.image_labels.empty() != arguments.calib.empty()) {
    throw InputError("--image-labels and --calib go together");
  }
  if (arguments.output.empty()) throw InputError("--output is needed");

  const LabelledClasses classes = loadLabelledClasses(arguments.classes);
  std::vector<Setting> overrides;
  for (const std::string& text : arguments.overrides) overrides.push_back(parseOverride(text));
  const ExtractionConfig config = loadExtractionConfig(classes.classes, arguments.config, overrides);
  const Extraction extraction = extract(arguments, classes.labels, config);
  reportProblems(extraction, arguments);
  writeFileAtomically(arguments.output, formatObjects({extraction.detections()}, classes.classes));
  std::printf("%zu objects of %zu points in %s\n", extraction.objects.size(), extraction.points,
              arguments.output.c_str());
  return 0;
}

}  // namespace
}  // namespace semantic_mht_slam

int main(int argc, char** argv) {
  return semantic_mht_slam::runProgram("extract_objects", [&] { return semantic_mht_slam::run(argc, argv); });
}
