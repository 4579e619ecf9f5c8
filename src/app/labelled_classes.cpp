#include "semantic_mht_slam/app/labelled_classes.h"

#include <filesystem>

#include "semantic_mht_slam/app/system_config.h"
#include "semantic_mht_slam/io/existing_path.h"
#include "semantic_mht_slam/io/label_map_file.h"
#include "semantic_mht_slam/io/yaml_file.h"

namespace semantic_mht_slam {
namespace {

namespace fs = std::filesystem;

/// A file beside another one, else one of the package.
std::string locateBeside(const std::string& file, const std::string& name) {
  const fs::path beside = fs::path(file).parent_path() / name;
  return mayExist(beside.string()) ? beside.string() : packageConfigFile(name);
}

/// "labels_X.yaml" beside a table "classes_X.yaml"; empty if there is none.
std::string labelMapOf(const std::string& table) {
  const std::string prefix = "classes_";
  const std::string name = fs::path(table).filename().string();
  if (name.compare(0, prefix.size(), prefix) != 0) return "";
  const fs::path map = fs::path(table).parent_path() / ("labels_" + name.substr(prefix.size()));
  return mayExist(map.string()) ? map.string() : "";
}

}  // namespace

LabelledClasses loadLabelledClasses(const std::string& file) {
  const std::string path = mayExist(file) || fs::path(file).is_absolute() ? file : packageConfigFile(file);
  if (isLabelMap(path)) {
    const ClassTable classes = readClassTable(locateBeside(path, classTableOfLabelMap(path)));
    return {classes, readLabelMap(path, classes)};
  }
  const ClassTable classes = readClassTable(path);
  const std::string map = labelMapOf(path);
  return {classes, map.empty() ? LabelMap::ofTable(classes) : readLabelMap(map, classes)};
}

}  // namespace semantic_mht_slam
