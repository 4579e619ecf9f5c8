#include "semantic_mht_slam/io/yaml_file.h"

#include <set>

#include <yaml-cpp/yaml.h>

#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/io/text_file.h"

#include "yaml_document.h"

namespace semantic_mht_slam {
namespace {

constexpr int kMaxDepth = 20;
constexpr std::size_t kMaxSettings = 100000;  // more than any file has; a node may stand in itself many times over

void flatten(const std::string& path, const YAML::Node& node, const std::string& prefix, std::vector<Setting>& settings,
             int depth = 0) {
  if (depth > kMaxDepth) throw InputError(path + ": '" + prefix + "' is nested too deeply, or in itself");
  if (!node.IsMap()) throw InputError(originOf(path, node) + ": '" + prefix + "' should hold keys and values");
  for (const auto& item : node) {
    if (!item.first.IsScalar()) throw InputError(originOf(path, item.first) + ": a key that is no text");
    const std::string key = (prefix.empty() ? "" : prefix + ".") + item.first.Scalar();
    if (item.second.IsMap()) {
      flatten(path, item.second, key, settings, depth + 1);
    } else if (item.second.IsScalar()) {
      if (settings.size() >= kMaxSettings) throw InputError(path + ": holds too many values");
      settings.push_back({key, item.second.Scalar(), originOf(path, item.second)});
    } else {
      throw InputError(originOf(path, item.first) + ": '" + key + "' has no single value");
    }
  }
}

std::vector<Setting> flattenedOnce(const std::string& path, const YAML::Node& node) {
  std::vector<Setting> settings;
  if (node.IsNull()) return settings;  // an empty file changes nothing
  flatten(path, node, "", settings);
  std::set<std::string> seen;
  std::vector<std::string> problems;
  for (const Setting& setting : settings) {
    if (!seen.insert(setting.key).second) problems.push_back(setting.origin + ": '" + setting.key + "' stands twice");
  }
  if (!problems.empty()) throw ConfigError(problems);
  return settings;
}

}  // namespace

std::vector<Setting> readSettings(const std::string& path) {
  return flattenedOnce(path, loadYaml(path));
}

ClassTable readClassTable(const std::string& path) {
  const YAML::Node root = loadYaml(path);
  if (!root.IsMap() || root.size() != 1 || !root["classes"] || !root["classes"].IsSequence()) {
    throw InputError(path + ": a class table holds the one key 'classes' with a list");
  }
  std::vector<ClassInfo> classes;
  std::vector<std::string> problems;
  for (const YAML::Node& node : root["classes"]) {
    ClassInfo info;
    Fields fields;
    describe(info, fields);
    try {
      applySettings(flattenedOnce(path, node), fields);
    } catch (const ConfigError& error) {
      problems.insert(problems.end(), error.problems().begin(), error.problems().end());
    }
    classes.push_back(info);
  }
  if (!problems.empty()) throw ConfigError(problems);
  return ClassTable(std::move(classes), path);
}

}  // namespace semantic_mht_slam
