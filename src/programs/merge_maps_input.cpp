#include "merge_maps_input.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <set>
#include <sstream>
#include <utility>

#include "semantic_mht_slam/bags/finished_map.h"
#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/io/text_file.h"
#include "semantic_mht_slam/merging/landmark_map.h"

namespace semantic_mht_slam {
namespace {

/// A line of a file of bare landmarks.
struct LandmarkLine {
  std::string label;
  Eigen::Vector3d position_m;
};

bool isMapFile(const std::string& file) {
  return std::filesystem::path(file).extension() == ".bag";
}

std::vector<LandmarkLine> readLandmarkLines(const std::string& file) {
  std::vector<LandmarkLine> lines;
  const std::string content = readFile(file);
  forEachLine(content, [&](int number, std::string_view text) {
    std::string line(text);
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream cells(line);
    LandmarkLine landmark;
    double x = 0.0, y = 0.0, z = 0.0;
    std::string more;
    if (!(cells >> landmark.label >> x >> y >> z) || cells >> more) {
      throw InputError(at(file, number) + ": a landmark is 'class x y z'");
    }
    landmark.position_m = {x, y, z};
    lines.push_back(landmark);
  });
  return lines;
}

std::optional<ClassIndex> findClass(const ClassTable& classes, const std::string& label) {
  if (const auto by_name = classes.findName(label)) return by_name;
  std::istringstream text(label);
  int id = 0;
  return text >> id && text.eof() ? classes.findId(id) : std::nullopt;
}

/// The labels of bare landmarks as classes.
ClassTable classesOf(const std::vector<std::vector<LandmarkLine>>& files) {
  std::set<std::string> labels;
  for (const auto& lines : files) {
    for (const LandmarkLine& line : lines) labels.insert(line.label);
  }
  std::vector<ClassInfo> classes;
  for (const std::string& label : labels) {
    ClassInfo info;
    info.id = static_cast<int>(classes.size());
    info.name = label;
    classes.push_back(info);
  }
  return ClassTable(classes, "the landmarks");
}

bool areDistinct(const std::vector<std::string>& names) {
  return std::set<std::string>(names.begin(), names.end()).size() == names.size();
}

/// Their file names; with the folder, or as they are, if these are not distinct.
std::vector<std::string> namesOf(const std::vector<std::string>& files) {
  if (!areDistinct(files)) throw InputError("a map is named twice");
  std::vector<std::string> names;
  std::vector<std::string> with_folder;
  for (const std::filesystem::path file : files) {
    names.push_back(file.filename().string());
    with_folder.push_back((file.parent_path().filename() / file.filename()).string());
  }
  if (areDistinct(names)) return names;
  return areDistinct(with_folder) ? with_folder : files;
}

SlamParts makeLandmarkMap(const std::string& file, const std::vector<LandmarkLine>& lines, const MapInputs& inputs) {
  std::vector<BareLandmark> landmarks;
  for (const LandmarkLine& line : lines) {
    const auto found = findClass(inputs.classes, line.label);
    if (!found) throw InputError(file + ": the class table lacks the class '" + line.label + "'");
    landmarks.push_back({*found, line.position_m});
  }
  try {
    return makeLandmarkMap(landmarks, inputs.slam_config, inputs.classes);
  } catch (const InputError& error) {
    throw InputError(file + ": " + error.what());
  }
}

}  // namespace

MapInputs readMaps(const std::vector<std::string>& files, const std::string& config_file,
                   const std::vector<std::string>& settings) {
  MapInputs inputs;
  std::vector<Setting> overrides;
  for (const std::string& text : settings) overrides.push_back(parseOverride(text));
  inputs.config = loadSystemConfig(config_file, overrides);
  const std::string folder = std::filesystem::path(config_file).parent_path().string();
  inputs.config.class_table = locateClassTable(inputs.config, folder);
  inputs.config.slam.back_end.evaluator.tree = locateEvaluatorTree(inputs.config, folder);
  inputs.classes = loadClassTable(inputs.config, folder);
  inputs.slam_config = loadableSlamConfig(inputs.config, folder);
  const std::vector<std::string> names = namesOf(files);

  std::vector<std::vector<LandmarkLine>> bare;
  for (const std::string& file : files) {
    bare.push_back(isMapFile(file) ? std::vector<LandmarkLine>{} : readLandmarkLines(file));
  }
  const auto is_unknown = [&](const LandmarkLine& line) { return !findClass(inputs.classes, line.label); };
  if (std::none_of(files.begin(), files.end(), isMapFile) &&
      std::any_of(bare.begin(), bare.end(), [&](const std::vector<LandmarkLine>& lines) {
        return std::any_of(lines.begin(), lines.end(), is_unknown);
      })) {
    inputs.classes = classesOf(bare);
  }
  for (std::size_t i = 0; i < files.size(); ++i) {
    if (isMapFile(files[i])) {
      inputs.estimators.push_back(readFinishedMap(
          files[i], inputs.config, inputs.slam_config, inputs.classes, [] { return true; },
          [](const std::string& remark) { std::fprintf(stderr, "%s\n", remark.c_str()); }));
      inputs.maps.emplace_back(names[i], *inputs.estimators.back());
    } else {
      inputs.landmark_maps.push_back(std::make_unique<SlamParts>(makeLandmarkMap(files[i], bare[i], inputs)));
      inputs.maps.emplace_back(names[i], *inputs.landmark_maps.back());
    }
  }
  return inputs;
}

}  // namespace semantic_mht_slam
