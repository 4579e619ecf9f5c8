#include "semantic_mht_slam/io/g2o_file.h"

#include "fuzz/fuzz_target.h"
#include "fuzz/fuzzed_file.h"
#include "support/text_mutation.h"

namespace semantic_mht_slam {

FuzzTarget g2oTarget() {
  const auto run = [](const std::string& bytes) {
    const FuzzedFile file(bytes);
    readOrRefuse([&] { readG2o(file.path(), BadInformation::kProject); });
    std::string written;
    if (!readOrRefuse([&] { written = formatG2o(readG2o(file.path())); })) return false;
    parseG2o(written, "what was written");  // is never refused
    return true;
  };
  return {"g2o",
          run,
          {"VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0\nEDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\n",
           "VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\nVERTEX_SE3:QUAT 1 1 0 0 0 0 0 1\nEDGE_SE3:QUAT 0 1 1 0 0 0 0 0 1 "
           "1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 1 0 0 1 0 1\n",
           "2\n# planar\nVERTEX_SE2 0 0 0 0\nFIX 0\nVERTEX_XY 5 2 0\nEDGE_SE2 0 1 1 0 0 2 1 0 2 0 1\n"
           "EDGE_SE2_XY 1 5 1 0 1 0 1\n",
           "PARAMS_SE3OFFSET 0 0 0 0 0 0 0 1\nVERTEX_TRACKXYZ 9 1 2 3\nEDGE_SE3_TRACKXYZ 3 9 0 1 2 3 1 0 0 1 0 1\n"
           "EDGE_SE3:QUAT 3 4 1 0 0 0 0 0 1 1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 1 0 0 1 0 1\nFIX 3 4\n"},
          mutatedText};
}

}  // namespace semantic_mht_slam
