#include "yaml_document.h"

#include <sstream>

#include <yaml-cpp/eventhandler.h>

#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/io/text_file.h"

namespace semantic_mht_slam {
namespace {

/// Wants to know nothing of a document.
class NoHandler final : public YAML::EventHandler {
 public:
  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
  void OnAlias(const YAML::Mark&, YAML::anchor_t) override {}
  void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t, const std::string&) override {}
  void OnSequenceStart(const YAML::Mark&, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark&, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {}
  void OnMapEnd() override {}
};

/// Two at most: of a text such as "," the parser makes documents without end.
bool isOneDocument(const std::string& content) {
  std::istringstream stream(content);
  YAML::Parser parser(stream);
  NoHandler handler;
  parser.HandleNextDocument(handler);
  return !parser.HandleNextDocument(handler);
}

}  // namespace

std::string originOf(const std::string& path, const YAML::Node& node) {
  return at(path, node.Mark().line + 1);
}

YAML::Node loadYaml(const std::string& path) {
  const std::string content = readFile(path);
  try {
    if (!isOneDocument(content)) {
      throw InputError(path + ": holds more than one YAML document, or a comma or bracket where none belongs");
    }
    return YAML::Load(content);
  } catch (const YAML::Exception& error) {
    throw InputError(at(path, error.mark.line + 1) + ": not YAML: " + error.msg);
  }
}

}  // namespace semantic_mht_slam
