#include <cstdio>
#include <string>
#include <vector>

#include <boost/program_options.hpp>

#include "semantic_mht_slam/app/labelled_classes.h"
#include "semantic_mht_slam/app/system_config.h"
#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/io/objects_file.h"
#include "semantic_mht_slam/io/scan_file.h"
#include "semantic_mht_slam/io/text_file.h"
#include "semantic_mht_slam/io/yaml_file.h"
#include "semantic_mht_slam/perception/cloud_extractor.h"

#include "program.h"

namespace po = boost::program_options;

namespace semantic_mht_slam {
namespace {

constexpr const char* kUsage =
    "Extracts the objects of one scan.\n"
    "  extract_objects --scan FILE.bin --labels FILE.label [--classes FILE] --output objects.csv\n";

struct Arguments {
  std::string scan;
  std::string labels;
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
  add("classes", po::value(&arguments.classes)->value_name("FILE"),
      "label map or class table; default: SemanticKITTI's raw ids, labels_semantic_kitti.yaml");
  add("config", po::value(&arguments.config)->value_name("FILE"), "parameters of the extraction, YAML");
  add("set", po::value(&arguments.overrides)->value_name("KEY=VALUE")->composing(), "changes one parameter");
  add("output", po::value(&arguments.output)->value_name("FILE"), "objects CSV, all rows of frame 0");
  return options;
}

ExtractionConfig loadConfig(const Arguments& arguments, const ClassTable& classes) {
  ExtractionConfig config(classes);
  Fields fields;
  describe(config, fields);
  std::vector<Setting> settings;
  if (!arguments.config.empty()) settings = readSettings(arguments.config);
  for (const std::string& text : arguments.overrides) settings.push_back(parseOverride(text));
  applySettings(settings, fields);
  return config;
}

int run(int argc, char** argv) {
  Arguments arguments;
  if (!parseOrHelp({argv + 1, argv + argc}, kUsage, makeOptions(arguments))) return 0;
  if (arguments.scan.empty()) throw InputError("--scan is needed");
  if (arguments.labels.empty()) throw InputError("--labels is needed");
  if (arguments.output.empty()) throw InputError("--output is needed");

  const LabelledClasses classes = loadLabelledClasses(arguments.classes);
  const ExtractionConfig config = loadConfig(arguments, classes.classes);
  const LabelledCloud cloud = readLabelledScan(arguments.scan, arguments.labels);
  const Extraction extraction = extractObjects(cloud, classes.labels, config);
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
