// A section of a map file, as it is after its digest was found right: the first byte says which, the others are its
// bytes. What is not refused is driven on with. With SMHT_FUZZ_SEEDS=FOLDER writes the sections of a good map there.
#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "semantic_mht_slam/slam/slam.h"

#include "fuzz/fuzzed_file.h"
#include "support/square_drive.h"

namespace semantic_mht_slam {
namespace {

constexpr int kDriven = 130;
constexpr int kFurther = 20;

struct Fixture {
  const SlamConfig config = defaultsOf(Method::kDpmhm);
  const ClassTable classes = makeStreetClasses();
  const SquareDrive drive{7};
  SlamState state;

  Fixture() {
    Slam slam(config, classes);
    drive.feed(slam, 0, kDriven);
    state = slam.snapshot();
    const char* folder = std::getenv("SMHT_FUZZ_SEEDS");
    for (std::size_t i = 0; folder != nullptr && i < state.sections.size(); ++i) {
      std::ofstream seed(std::string(folder) + "/" + state.sections[i].name, std::ios::binary);
      seed.put(static_cast<char>(i));
      seed << state.sections[i].bytes;
    }
  }
};

}  // namespace
}  // namespace semantic_mht_slam

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace semantic_mht_slam;
  static const Fixture fixture;
  if (size == 0) return 0;
  SlamState state = fixture.state;
  state.sections[data[0] % state.sections.size()].bytes.assign(reinterpret_cast<const char*>(data) + 1, size - 1);
  readOrRefuse([&] {
    Slam slam(fixture.config, fixture.classes, state);
    fixture.drive.feed(slam, kDriven, kDriven + kFurther);
    slam.finish();
    trajectoryOf(slam);
    landmarksOf(slam);
  });
  return 0;
}
