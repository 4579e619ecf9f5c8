#include "semantic_mht_slam/place/submap_classifier.h"

#include "fuzz/fuzzed_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace semantic_mht_slam;
  const FuzzedFile file(data, size);
  readOrRefuse([&] {
    const SubmapClassifier classifier = SubmapClassifier::load(file.path());
    classifier.goodProb({1.0, 0.5, 20});
  });
  return 0;
}
