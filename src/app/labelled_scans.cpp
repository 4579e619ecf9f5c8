#include "semantic_mht_slam/app/labelled_scans.h"

#include <array>
#include <cstdio>
#include <filesystem>

#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/io/existing_path.h"
#include "semantic_mht_slam/io/scan_file.h"
#include "semantic_mht_slam/io/yaml_file.h"
#include "semantic_mht_slam/perception/cloud_extractor.h"

namespace semantic_mht_slam {
namespace {

namespace fs = std::filesystem;

/// "NNNNNN", KITTI's name of a frame.
std::string nameOf(std::size_t frame) {
  std::array<char, 32> name{};
  std::snprintf(name.data(), name.size(), "%06zu", frame);
  return name.data();
}

/// Remembers what is wrong with the first scan that has it.
class ScanProblems {
 public:
  void add(const std::string& scan, const Extraction& extraction) {
    if (!extraction.unknown_labels.empty() && !has_unknown_) {
      has_unknown_ = true;
      problems_.push_back(scan + ": skipped " + extraction.describeUnknownLabels("points"));
    }
    if (extraction.points_not_finite > 0 && !has_not_finite_) {
      has_not_finite_ = true;
      problems_.push_back(scan + ": skipped " + std::to_string(extraction.points_not_finite) +
                          " points that are not finite");
    }
  }

  const std::vector<std::string>& all() const { return problems_; }

 private:
  bool has_unknown_ = false;
  bool has_not_finite_ = false;
  std::vector<std::string> problems_;
};

}  // namespace

bool hasLabelledScans(const std::string& folder) {
  return isFolder(folder + "/velodyne") && isFolder(folder + "/labels");
}

ExtractionConfig loadExtractionConfig(const ClassTable& classes, const std::string& yaml_path,
                                      const std::vector<Setting>& overrides) {
  ExtractionConfig config(classes);
  Fields fields;
  describe(config, fields);
  std::vector<Setting> settings;
  if (!yaml_path.empty()) settings = readSettings(yaml_path);
  settings.insert(settings.end(), overrides.begin(), overrides.end());
  applySettings(settings, fields);
  requireUsable(config);
  return config;
}

ExtractedScans extractScans(const std::string& folder, const std::vector<StampedPose>& frames,
                            const LabelledClasses& labelled, const ExtractionConfig& config,
                            const std::function<void(std::size_t, std::size_t)>& progress) {
  ExtractedScans result;
  ScanProblems problems;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const fs::path scan = fs::path(folder) / "velodyne" / (nameOf(i) + ".bin");
    const fs::path labels = fs::path(folder) / "labels" / (nameOf(i) + ".label");
    if (mayExist(scan.string()) && mayExist(labels.string())) {
      const Extraction extraction =
          extractObjects(readLabelledScan(scan.string(), labels.string()), labelled.labels, config);
      problems.add(labels.string(), extraction);
      result.frames.push_back({frames[i].stamp, extraction.detections()});
    } else {
      ++result.without_scan;
    }
    progress(i + 1, frames.size());
  }
  if (result.frames.empty()) {
    throw InputError(folder + ": no frame has both velodyne/NNNNNN.bin and labels/NNNNNN.label");
  }
  result.problems = problems.all();
  return result;
}

}  // namespace semantic_mht_slam
