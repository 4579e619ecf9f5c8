// The state of a map file may come from anybody: whatever it holds, it is refused by the name of its section, or the
// estimator goes on with it.
#include <algorithm>
#include <cstdlib>

#include <gtest/gtest.h>

#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/slam/slam.h"

#include "support/expect_input_error.h"
#include "support/peak_memory.h"
#include "support/square_drive.h"
#include "support/state_mutation.h"

namespace semantic_mht_slam {
namespace {

constexpr int kDriven = 560;  // more than a round: with loop closures
constexpr int kFurther = 25;
constexpr int kUsed = 5;  // every so-manyth state that is taken is driven on with

/// All that is asked of an estimator.
void useFor(Slam& slam, const SquareDrive& drive, int frames) {
  drive.feed(slam, kDriven, kDriven + frames);
  slam.finish();
  if (!slam.map().submaps().empty()) slam.localize();
  drive.feed(slam, kDriven + frames, kDriven + frames + 3);
  trajectoryOf(slam);
  landmarksOf(slam);
  slam.map().associations();
  slam.parts().sessions.summary(slam.map());
  slam.snapshot();
}

class HostileStateTest : public testing::TestWithParam<int> {
 protected:
  const SlamConfig config_ = defaultsOf(Method::kDpmhm);
  const ClassTable classes_ = makeStreetClasses();
  const SquareDrive drive_{7};
  const SlamState& state_ = stateOfTheDrive(config_, classes_, drive_);

 private:
  static const SlamState& stateOfTheDrive(const SlamConfig& config, const ClassTable& classes,
                                          const SquareDrive& drive) {
    static const SlamState state = [&] {
      Slam slam(config, classes);
      drive.feed(slam, 0, kDriven);
      return slam.snapshot();
    }();
    return state;
  }
};

/// How many states are tried; more by SMHT_HOSTILE_STATES.
int trials() {
  const char* wanted = std::getenv("SMHT_HOSTILE_STATES");
  return wanted == nullptr ? 200 : std::atoi(wanted);
}

TEST_P(HostileStateTest, WhatIsChangedIsRefusedByNameOrLivedWith) {
  const auto section = static_cast<std::size_t>(GetParam());
  const std::string name = state_.sections.at(section).name;
  int loaded = 0;
  int refused = 0;
  PeakMemory memory;
  double most_mb = 0.0;
  for (int trial = 0; trial < trials(); ++trial) {
    Rng rng = Rng(11).fork(name, static_cast<std::uint64_t>(trial));
    SlamState state = state_;
    state.sections[section].bytes = mutated(std::move(state.sections[section].bytes), rng);
    const bool is_measured = memory.begin();
    try {
      Slam slam(config_, classes_, state);
      ++loaded;
      most_mb = std::max(most_mb, is_measured ? memory.grown_mb() : 0.0);
      if (loaded % kUsed != 1) continue;
      EXPECT_NO_THROW(useFor(slam, drive_, kFurther)) << name << ", trial " << trial;
    } catch (const InputError& error) {
      ++refused;
      most_mb = std::max(most_mb, is_measured ? memory.grown_mb() : 0.0);
      EXPECT_NE(std::string(error.what()).find("section '"), std::string::npos) << error.what();
    } catch (const std::exception& error) {
      ADD_FAILURE() << name << ", trial " << trial << ": " << error.what();
    }
  }
  EXPECT_GT(refused, trials() / 10);
  double state_mb = 0.0;
  for (const StateSection& good : state_.sections) state_mb += 1e-6 * static_cast<double>(good.bytes.size());
  EXPECT_LE(most_mb, 3.0 * state_mb + 50.0) << "of a state of " << state_mb << " MB";
  RecordProperty("loaded", loaded);
}

/// They made a negative way between two keyframes, whose covariance the pose graph refuses.
TEST(HostileNumberTest, FramesThatLeadAnotherWayAreRefused) {
  const SlamConfig config = defaultsOf(Method::kDpmhm);
  const ClassTable classes = makeStreetClasses();
  Slam slam(config, classes);
  SquareDrive(7).feed(slam, 0, 130);
  const SlamState good = slam.snapshot();
  const auto expectRefused = [&](double from, double to, const std::string& reason) {
    SlamState state = good;
    for (StateSection& section : state.sections) {
      if (section.name == "hypotheses") section.bytes = withNumber(std::move(section.bytes), from, to);
    }
    expectInputError([&] { Slam(config, classes, state); }, {"section 'hypotheses'", reason});
  };
  const double north_m = slam.parts().latest_frame->T_odom_base.translation_m.y();
  expectRefused(north_m, north_m - 4.0, "lead another way");
}

INSTANTIATE_TEST_SUITE_P(Sections, HostileStateTest, testing::Range(0, 6));

}  // namespace
}  // namespace semantic_mht_slam
