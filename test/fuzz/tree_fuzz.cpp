#include "semantic_mht_slam/io/text_file.h"
#include "semantic_mht_slam/place/submap_classifier.h"

#include "fuzz/fuzz_target.h"
#include "fuzz/fuzzed_file.h"
#include "support/text_mutation.h"

namespace semantic_mht_slam {

FuzzTarget treeTarget() {
  const auto run = [](const std::string& bytes) {
    const FuzzedFile file(bytes);
    return readOrRefuse([&] {
      const SubmapClassifier tree = SubmapClassifier::load(file.path());
      for (const double entropy : {0.0, 1.0, 8.0, 9.0})
        tree.goodProb({entropy, 0.1 * entropy, static_cast<int>(4 * entropy)});
    });
  };
  return {"tree", run, {readFile(SMHT_SOURCE_DIR "/config/submap_evaluator.yaml")}, mutatedText};
}

}  // namespace semantic_mht_slam
