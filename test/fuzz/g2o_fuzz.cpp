#include "semantic_mht_slam/io/g2o_file.h"

#include "fuzz/fuzzed_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace semantic_mht_slam;
  const FuzzedFile file(data, size);
  readOrRefuse([&] { formatG2o(readG2o(file.path())); });
  return 0;
}
