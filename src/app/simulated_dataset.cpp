#include "semantic_mht_slam/app/simulated_dataset.h"

#include "semantic_mht_slam/app/system_config.h"
#include "semantic_mht_slam/common/text.h"
#include "semantic_mht_slam/io/dataset.h"
#include "semantic_mht_slam/io/text_file.h"
#include "semantic_mht_slam/io/yaml_file.h"

namespace semantic_mht_slam {
namespace {

std::string formatTruthIds(const SimulatedDrive& drive) {
  std::string text = "frame,landmark\n";
  for (std::size_t frame = 0; frame < drive.truth_ids.size(); ++frame) {
    for (const int id : drive.truth_ids[frame]) text += std::to_string(frame) + "," + std::to_string(id) + "\n";
  }
  return text;
}

std::string formatLandmarks(const SimulatedDrive& drive, const ClassTable& classes) {
  std::string text = "landmark,class,x,y,z\n";
  for (const SimulatedLandmark& landmark : drive.landmarks) {
    text += std::to_string(landmark.id) + "," + classes[landmark.class_index].name;
    for (int i = 0; i < 3; ++i) text += "," + formatFixed(landmark.position_m[i], 3);
    text += "\n";
  }
  return text;
}

std::string formatLoopPairs(const SimulatedDrive& drive) {
  std::string text = "i,j\n";
  for (const auto& [i, j] : drive.loop_pairs) text += std::to_string(i) + "," + std::to_string(j) + "\n";
  return text;
}

}  // namespace

Scenario loadScenario(const std::string& path, const std::vector<std::string>& overrides) {
  std::vector<Setting> settings = readSettings(path);
  for (const std::string& text : overrides) settings.push_back(parseOverride(text));
  Scenario scenario;
  Fields fields;
  describe(scenario, fields);
  applySettings(settings, fields);
  return scenario;
}

void writeSimulatedDataset(const SimulatedDrive& drive, const ClassTable& classes, const std::string& folder) {
  Dataset dataset;
  dataset.stamps = drive.stamps;
  dataset.T_cam0_base = drive.T_cam0_base;
  dataset.T_odom_base = drive.T_odom_base;
  dataset.detections = drive.detections;
  dataset.T_map_base = drive.T_map_base;
  writeDataset(dataset, classes, folder);
  writeFileAtomically(folder + "/objects_landmark.csv", formatTruthIds(drive));
  writeFileAtomically(folder + "/landmarks.csv", formatLandmarks(drive, classes));
  writeFileAtomically(folder + "/loop_pairs.csv", formatLoopPairs(drive));
}

}  // namespace semantic_mht_slam
