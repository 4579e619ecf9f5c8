// A section of a map file, as it is after its digest was found right: the first byte says which, the others are its
// bytes.
#include <memory>

#include "semantic_mht_slam/slam/slam.h"

#include "fuzz/fuzz_target.h"
#include "fuzz/fuzzed_file.h"
#include "support/square_drive.h"
#include "support/state_mutation.h"

namespace semantic_mht_slam {
namespace {

constexpr int kFurther = 100;

/// An estimator that has driven so far, and what follows.
struct Driven {
  const SlamConfig config = defaultsOf(Method::kDpmhm);
  const ClassTable classes = makeStreetClasses();
  const SquareDrive drive{7};
  const int frames;
  SlamState state;

  explicit Driven(int driven) : frames(driven) {
    Slam slam(config, classes);
    drive.feed(slam, 0, frames);
    state = slam.snapshot();
  }

  std::vector<std::string> seeds() const {
    std::vector<std::string> seeds;
    for (std::size_t i = 0; i < state.sections.size(); ++i) {
      seeds.push_back(std::string(1, static_cast<char>(i)) + state.sections[i].bytes);
    }
    return seeds;
  }

  template <class Use>
  bool load(const std::string& bytes, const Use& use) const {
    if (bytes.empty()) return false;
    SlamState changed = state;
    changed.sections[static_cast<unsigned char>(bytes[0]) % changed.sections.size()].bytes = bytes.substr(1);
    std::unique_ptr<Slam> slam;
    readOrRefuse([&] { slam = std::make_unique<Slam>(config, classes, changed); });
    if (slam != nullptr) use(*slam);
    return slam != nullptr;
  }
};

}  // namespace

FuzzTarget mapSectionTarget() {
  const auto driven = std::make_shared<Driven>(60);
  return {"map_section", [driven](const std::string& bytes) { return driven->load(bytes, [](Slam&) {}); },
          driven->seeds(), mutated};
}

FuzzTarget mapStateTarget() {
  const auto driven = std::make_shared<Driven>(130);
  const auto goOn = [driven](Slam& slam) {
    driven->drive.feed(slam, driven->frames, driven->frames + kFurther);
    slam.finish();
    trajectoryOf(slam);
    landmarksOf(slam);
    slam.snapshot();
  };
  return {"map_state", [driven, goOn](const std::string& bytes) { return driven->load(bytes, goOn); }, driven->seeds(),
          mutated};
}

}  // namespace semantic_mht_slam
