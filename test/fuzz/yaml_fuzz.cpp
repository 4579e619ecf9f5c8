#include "semantic_mht_slam/io/yaml_file.h"
#include "semantic_mht_slam/slam/slam.h"

#include "fuzz/fuzzed_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace semantic_mht_slam;
  const FuzzedFile file(data, size);
  readOrRefuse([&] { readClassTable(file.path()); });
  readOrRefuse([&] {
    SlamConfig config;
    Fields fields;
    describe(config, fields);
    applySettings(readSettings(file.path()), fields);
  });
  return 0;
}
