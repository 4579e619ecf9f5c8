#include "semantic_mht_slam/io/label_map_file.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/common/text.h"

#include "yaml_document.h"

namespace semantic_mht_slam {
namespace {

const std::vector<std::string> kKeys = {"class_table", "labels", "moving", "ignored"};

/// Reads the parts of a label map and gathers what is wrong with them.
class LabelMapReader {
 public:
  LabelMapReader(const std::string& path, const ClassTable& classes) : path_(path), classes_(classes) {}

  LabelMap read(const YAML::Node& root) {
    requireKnownKeys(root);
    readRules(root["labels"], "labels", false);
    if (root["moving"]) readRules(root["moving"], "moving", true);
    if (root["ignored"]) readIgnored(root["ignored"]);
    if (!problems_.empty()) throw ConfigError(problems_);
    return LabelMap(rules_, ignored_, path_);
  }

 private:
  void report(const YAML::Node& node, const std::string& problem) {
    problems_.push_back(originOf(path_, node) + ": " + problem);
  }

  void requireKnownKeys(const YAML::Node& root) {
    for (const auto& item : root) {
      const std::string key = item.first.IsScalar() ? item.first.Scalar() : "";
      if (std::find(kKeys.begin(), kKeys.end(), key) == kKeys.end()) {
        report(item.first, "unknown key '" + key + "', known are " + joined(kKeys));
      }
    }
  }

  std::optional<int> readId(const YAML::Node& node) {
    const std::optional<std::int64_t> id = node.IsScalar() ? parseInteger(node.Scalar()) : std::nullopt;
    if (id && *id >= 0 && *id <= LabelMap::kMaxId) return static_cast<int>(*id);
    report(node, "a label id is a whole number in [0, " + std::to_string(LabelMap::kMaxId) + "]");
    return std::nullopt;
  }

  void readRules(const YAML::Node& node, const std::string& key, bool is_moving) {
    if (!node.IsMap()) return report(node, "'" + key + "' should hold label ids and class names");
    for (const auto& item : node) {
      const std::optional<int> id = readId(item.first);
      const std::string name = item.second.IsScalar() ? item.second.Scalar() : "";
      const std::optional<ClassIndex> class_index = classes_.findName(name);
      if (!class_index) report(item.first, "unknown class '" + name + "', known are " + classes_.names());
      if (id && class_index) rules_.push_back({*id, *class_index, is_moving});
    }
  }

  void readIgnored(const YAML::Node& node) {
    if (!node.IsSequence()) return report(node, "'ignored' should be a list of label ids");
    for (const YAML::Node& item : node) {
      if (const std::optional<int> id = readId(item)) ignored_.push_back(*id);
    }
  }

  const std::string& path_;
  const ClassTable& classes_;
  std::vector<LabelRule> rules_;
  std::vector<int> ignored_;
  std::vector<std::string> problems_;
};

}  // namespace

bool isLabelMap(const std::string& path) {
  const YAML::Node root = loadYaml(path);
  return root.IsMap() && root["labels"];
}

std::string classTableOfLabelMap(const std::string& path) {
  const YAML::Node root = loadYaml(path);
  if (!root.IsMap() || !root["class_table"] || !root["class_table"].IsScalar()) {
    throw InputError(path + ": a label map names its class table under the key 'class_table'");
  }
  return root["class_table"].Scalar();
}

LabelMap readLabelMap(const std::string& path, const ClassTable& classes) {
  const YAML::Node root = loadYaml(path);
  if (!root.IsMap() || !root["labels"]) throw InputError(path + ": a label map has the key 'labels'");
  return LabelMapReader(path, classes).read(root);
}

}  // namespace semantic_mht_slam
