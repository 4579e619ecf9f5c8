#include "semantic_mht_slam/io/objects_file.h"

#include "fuzz/fuzzed_file.h"
#include "support/square_drive.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace semantic_mht_slam;
  static const ClassTable classes = makeStreetClasses();
  const FuzzedFile file(data, size);
  readOrRefuse([&] { readObjects(file.path(), classes, 100); });
  return 0;
}
