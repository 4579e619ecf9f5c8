#include "semantic_mht_slam/io/text_file.h"
#include "semantic_mht_slam/place/submap_classifier.h"

#include "fuzz/fuzz_target.h"
#include "fuzz/fuzzed_file.h"

namespace semantic_mht_slam {

FuzzTarget treeTarget() {
  const auto run = [](const std::string& bytes) {
    const FuzzedFile file(bytes);
    return readOrRefuse([&] { SubmapClassifier::load(file.path()).goodProb({1.0, 0.5, 20}); });
  };
  return {"tree", run, {readFile(SMHT_SOURCE_DIR "/config/submap_evaluator.yaml")}};
}

}  // namespace semantic_mht_slam
