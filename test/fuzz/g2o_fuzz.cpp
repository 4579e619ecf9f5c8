#include "semantic_mht_slam/io/g2o_file.h"

#include "fuzz/fuzz_target.h"
#include "fuzz/fuzzed_file.h"

namespace semantic_mht_slam {

FuzzTarget g2oTarget() {
  const auto run = [](const std::string& bytes) {
    const FuzzedFile file(bytes);
    return readOrRefuse([&] { formatG2o(readG2o(file.path())); });
  };
  return {"g2o",
          run,
          {"VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0\nEDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\n",
           "VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\nVERTEX_SE3:QUAT 1 1 0 0 0 0 0 1\nEDGE_SE3:QUAT 0 1 1 0 0 0 0 0 1 "
           "1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 1 0 0 1 0 1\n"}};
}

}  // namespace semantic_mht_slam
