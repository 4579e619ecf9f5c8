#include "semantic_mht_slam/io/label_map_file.h"
#include "semantic_mht_slam/io/text_file.h"
#include "semantic_mht_slam/io/yaml_file.h"
#include "semantic_mht_slam/slam/slam.h"

#include "fuzz/fuzz_target.h"
#include "fuzz/fuzzed_file.h"
#include "support/square_drive.h"
#include "support/text_mutation.h"

namespace semantic_mht_slam {

FuzzTarget yamlTarget() {
  const auto run = [classes = makeStreetClasses()](const std::string& bytes) {
    const FuzzedFile file(bytes);
    bool is_taken = readOrRefuse([&] { readClassTable(file.path()); });
    is_taken |= readOrRefuse([&] { readLabelMap(file.path(), classes); });
    is_taken |= readOrRefuse([&] {
      SlamConfig config;
      Fields fields;
      describe(config, fields);
      applySettings(readSettings(file.path()), fields);
    });
    return is_taken;
  };
  return {
      "yaml",
      run,
      {"max_hypotheses: 20\nseed: 3\n", "classes:\n  - {id: 1, name: pole}\n  - {id: 2, name: trunk, static: true}\n",
       "class_table: t.yaml\nlabels: {1: pole, 2: trunk}\nmoving: {3: trunk}\nignored: [0, 7]\n",
       readFile(SMHT_SOURCE_DIR "/config/classes_semantic_kitti.yaml")},
      mutatedText};
}

}  // namespace semantic_mht_slam
