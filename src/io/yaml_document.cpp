#include "yaml_document.h"

#include <vector>

#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/io/text_file.h"

namespace semantic_mht_slam {

std::string originOf(const std::string& path, const YAML::Node& node) {
  return at(path, node.Mark().line + 1);
}

YAML::Node loadYaml(const std::string& path) {
  const std::string content = readFile(path);
  try {
    const std::vector<YAML::Node> documents = YAML::LoadAll(content);
    if (documents.size() > 1) throw InputError(path + ": holds more than one YAML document");
    return documents.empty() ? YAML::Node() : documents.front();
  } catch (const YAML::Exception& error) {
    throw InputError(at(path, error.mark.line + 1) + ": not YAML: " + error.msg);
  }
}

}  // namespace semantic_mht_slam
