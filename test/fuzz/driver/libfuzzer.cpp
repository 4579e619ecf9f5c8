// One target under libFuzzer: SMHT_FUZZ_TARGET names its function. With SMHT_FUZZ_SEEDS=FOLDER writes its seeds there.
// Says at the end how many inputs it took.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>

#include "fuzz/fuzz_target.h"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace {

const semantic_mht_slam::FuzzTarget& fuzzTarget() {
  static const semantic_mht_slam::FuzzTarget kTarget = semantic_mht_slam::SMHT_FUZZ_TARGET();
  return kTarget;
}

struct Taken {
  unsigned long inputs = 0;
  ~Taken() { std::fprintf(stderr, "taken: %lu\n", inputs); }
};

}  // namespace

/// What a target does once is none of the time of an input.
extern "C" int LLVMFuzzerInitialize(int*, char***) {
  fuzzTarget();
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const char* folder = std::getenv("SMHT_FUZZ_SEEDS");
  static Taken taken;
  const semantic_mht_slam::FuzzTarget& target = fuzzTarget();
  for (std::size_t i = 0; folder != nullptr && i < target.seeds.size(); ++i) {
    std::ofstream(std::string(folder) + "/seed_" + std::to_string(i), std::ios::binary) << target.seeds[i];
  }
  folder = nullptr;
  taken.inputs += target.run(std::string(reinterpret_cast<const char*>(data), size)) ? 1 : 0;
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned int seed) {
  const semantic_mht_slam::FuzzTarget& target = fuzzTarget();
  semantic_mht_slam::Rng rng(seed);
  if (!target.mutate || rng.bernoulli(0.5)) return LLVMFuzzerMutate(data, size, max_size);
  const std::string changed = target.mutate(std::string(reinterpret_cast<const char*>(data), size), rng);
  const std::size_t kept = std::min(changed.size(), max_size);
  std::memcpy(data, changed.data(), kept);
  return kept;
}
