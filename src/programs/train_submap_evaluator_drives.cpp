#include "train_submap_evaluator_drives.h"

#include <filesystem>

#include "semantic_mht_slam/app/recording.h"
#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/io/yaml_file.h"
#include "semantic_mht_slam/simulation/simulator.h"

namespace semantic_mht_slam {
namespace {

// A loop needs a drive in between: standing still at a crossing is none.
constexpr double kMinLoop_m = 50.0;

std::vector<double> drivenLengths(const std::vector<Pose>& T_map_base) {
  std::vector<double> driven_m(T_map_base.size(), 0.0);
  for (std::size_t i = 1; i < T_map_base.size(); ++i) {
    driven_m[i] = driven_m[i - 1] + (T_map_base[i].translation_m - T_map_base[i - 1].translation_m).norm();
  }
  return driven_m;
}

// For each frame, whether its place had been driven through before.
std::vector<bool> findRevisits(const std::vector<Pose>& T_map_base) {
  const std::vector<double> driven_m = drivenLengths(T_map_base);
  std::vector<bool> is_revisit(T_map_base.size(), false);
  for (const auto& [i, j] : findLoopPairs(T_map_base)) {
    if (driven_m[i] - driven_m[j] >= kMinLoop_m) is_revisit[i] = true;
  }
  return is_revisit;
}

Slam runSlam(const Recording& recording, const SlamConfig& config, const ClassTable& classes) {
  Slam slam(config, classes);
  auto frame = recording.detector_frames.begin();
  for (const StampedPose& T_odom_base : recording.odometry) {
    slam.addOdometry(T_odom_base);
    for (; frame != recording.detector_frames.end() && frame->stamp <= T_odom_base.stamp; ++frame) {
      slam.addDetections(frame->stamp, frame->detections);
    }
  }
  slam.finish();
  return slam;
}

LabelledDrive labelledDrive(const std::string& name, const Dataset& dataset, const SlamConfig& config,
                            const ClassTable& classes) {
  const std::vector<bool> is_revisit = findRevisits(*dataset.T_map_base);
  const Slam slam = runSlam(toRecording(dataset), config, classes);
  LabelledDrive drive{name, {}};
  SubmapFeatureExtractor extractor(classes.size());
  for (const auto& submap : slam.map().submaps()) {
    DrivenSubmap driven{extractor.add(*submap), false};
    for (std::size_t i = 0; i < dataset.stamps.size(); ++i) {
      const bool is_within = dataset.stamps[i] >= submap->begin && dataset.stamps[i] <= submap->end;
      driven.is_good = driven.is_good || (is_within && is_revisit[i]);
    }
    drive.submaps.push_back(driven);
  }
  return drive;
}

Scenario loadScenario(const std::string& path) {
  Scenario scenario;
  Fields fields;
  describe(scenario, fields);
  applySettings(readSettings(path), fields);
  return scenario;
}

}  // namespace

LabelledDrive simulateLabelledDrive(const std::string& scenario, std::uint64_t seed, const SlamConfig& config,
                                    const ClassTable& classes) {
  const SimulatedDrive drive = simulateDrive(loadScenario(scenario), classes, seed);
  Dataset dataset;
  dataset.stamps = drive.stamps;
  dataset.T_cam0_base = drive.T_cam0_base;
  dataset.T_odom_base = drive.T_odom_base;
  dataset.detections = drive.detections;
  dataset.T_map_base = drive.T_map_base;
  const std::string name = std::filesystem::path(scenario).stem().string() + " " + std::to_string(seed);
  return labelledDrive(name, dataset, config, classes);
}

LabelledDrive readLabelledDrive(const DatasetFiles& files, const SlamConfig& config, const ClassTable& classes) {
  const Dataset dataset = readDataset(files, classes);
  if (!dataset.T_map_base) throw InputError(files.folder + ": no poses.txt, from which submaps would be labelled");
  return labelledDrive(files.folder, dataset, config, classes);
}

}  // namespace semantic_mht_slam
