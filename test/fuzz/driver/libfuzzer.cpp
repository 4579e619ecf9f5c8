// One target under libFuzzer: SMHT_FUZZ_TARGET names its function. With SMHT_FUZZ_SEEDS=FOLDER writes its seeds there.
#include <cstdint>
#include <cstdlib>
#include <fstream>

#include "fuzz/fuzz_target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const semantic_mht_slam::FuzzTarget kTarget = semantic_mht_slam::SMHT_FUZZ_TARGET();
  static const char* folder = std::getenv("SMHT_FUZZ_SEEDS");
  for (std::size_t i = 0; folder != nullptr && i < kTarget.seeds.size(); ++i) {
    std::ofstream(std::string(folder) + "/seed_" + std::to_string(i), std::ios::binary) << kTarget.seeds[i];
  }
  folder = nullptr;
  kTarget.run(std::string(reinterpret_cast<const char*>(data), size));
  return 0;
}
