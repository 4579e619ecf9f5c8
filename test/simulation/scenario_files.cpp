#include "scenario_files.h"

#include "semantic_mht_slam/io/yaml_file.h"

namespace semantic_mht_slam {
ClassTable simulationClasses() {
  std::vector<ClassInfo> classes(1);
  classes[0].name = "road";
  for (const char* name : kTownClassNames) {
    ClassInfo info;
    info.id = static_cast<int>(classes.size());
    info.name = name;
    classes.push_back(info);
  }
  return ClassTable(classes, "test");
}

Scenario shippedScenario(const std::string& name) {
  Scenario scenario;
  Fields fields;
  describe(scenario, fields);
  applySettings(readSettings(std::string(SMHT_SOURCE_DIR) + "/config/scenarios/" + name + ".yaml"), fields);
  return scenario;
}

}  // namespace semantic_mht_slam
