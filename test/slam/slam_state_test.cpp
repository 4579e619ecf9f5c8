#include "semantic_mht_slam/slam/slam_state.h"

#include <gtest/gtest.h>

#include "semantic_mht_slam/common/random.h"
#include "semantic_mht_slam/slam/slam.h"

#include "support/expect_input_error.h"
#include "support/square_drive.h"

namespace semantic_mht_slam {
namespace {

void expectSameResult(const Slam& a, const Slam& b) {
  const auto trajectory_a = trajectoryOf(a);
  const auto trajectory_b = trajectoryOf(b);
  ASSERT_EQ(trajectory_a.size(), trajectory_b.size());
  for (std::size_t i = 0; i < trajectory_a.size(); ++i) {
    ASSERT_EQ(trajectory_a[i].stamp, trajectory_b[i].stamp);
    ASSERT_EQ(trajectory_a[i].T_world_base.matrix(), trajectory_b[i].T_world_base.matrix()) << i;
  }
  const auto landmarks_a = landmarksOf(a);
  const auto landmarks_b = landmarksOf(b);
  ASSERT_EQ(landmarks_a.size(), landmarks_b.size());
  for (std::size_t i = 0; i < landmarks_a.size(); ++i) {
    ASSERT_EQ(landmarks_a[i].id, landmarks_b[i].id);
    ASSERT_EQ(landmarks_a[i].position.mean_m, landmarks_b[i].position.mean_m);
    ASSERT_EQ(landmarks_a[i].position.cov_m2, landmarks_b[i].position.cov_m2);
    ASSERT_EQ(landmarks_a[i].merged_ids, landmarks_b[i].merged_ids);
  }
  const auto associations_a = a.map().associations();
  const auto associations_b = b.map().associations();
  ASSERT_EQ(associations_a.size(), associations_b.size());
  for (std::size_t i = 0; i < associations_a.size(); ++i) {
    ASSERT_EQ(associations_a[i].landmark, associations_b[i].landmark);
  }
  ASSERT_EQ(latestCovOf(a).has_value(), latestCovOf(b).has_value());
  ASSERT_EQ(latestCovOf(a).value_or(unknownPoseCov()), latestCovOf(b).value_or(unknownPoseCov()));
  ASSERT_EQ(a.map().closures().size(), b.map().closures().size());
  ASSERT_EQ(a.parts().assembler.counters().detections, b.parts().assembler.counters().detections);
}

void expectSameSections(const SlamState& a, const SlamState& b) {
  ASSERT_EQ(a.sections.size(), b.sections.size());
  for (std::size_t i = 0; i < a.sections.size(); ++i) {
    EXPECT_EQ(a.sections[i].name, b.sections[i].name);
    EXPECT_TRUE(a.sections[i].bytes == b.sections[i].bytes) << a.sections[i].name;
  }
}

class SlamStateTest : public testing::TestWithParam<int> {
 protected:
  static SlamConfig config() {
    SlamConfig config = defaultsOf(Method::kDpmhm);
    config.seed = static_cast<std::uint64_t>(GetParam());
    return config;
  }
};

TEST_P(SlamStateTest, GoingOnFromASnapshotEqualsNeverHavingStopped) {
  constexpr int kFrames = 1100;  // a second round and a part of a third
  const SquareDrive drive(static_cast<std::uint64_t>(GetParam()));
  const ClassTable classes = makeStreetClasses();
  Slam whole(config(), classes);
  drive.feed(whole, 0, kFrames);
  whole.finish();
  const auto accepted = [](const Slam& slam) {
    int count = 0;
    for (const LoopClosureRecord& record : slam.map().closures()) count += record.is_accepted ? 1 : 0;
    return count;
  };
  ASSERT_GT(accepted(whole), 5) << "the drive must close loops for the test to mean something";
  const int stops[] = {3, 117, 517 + 31 * GetParam(), 805};
  int fed = 0;
  auto slam = std::make_unique<Slam>(config(), classes);
  for (const int stop : stops) {
    drive.feed(*slam, fed, stop);
    fed = stop;
    slam = std::make_unique<Slam>(config(), classes, slam->snapshot());
  }
  drive.feed(*slam, fed, kFrames);
  slam->finish();
  expectSameResult(whole, *slam);
}

TEST_P(SlamStateTest, SnapshotOfARestoredEstimatorIsTheSame) {
  const SquareDrive drive(static_cast<std::uint64_t>(GetParam()));
  const ClassTable classes = makeStreetClasses();
  Slam slam(config(), classes);
  drive.feed(slam, 0, 700);
  const SlamState state = slam.snapshot();
  expectSameSections(state, Slam(config(), classes, state).snapshot());
}

INSTANTIATE_TEST_SUITE_P(Seeds, SlamStateTest, testing::Values(1, 2, 3));

TEST(SlamStateErrorTest, BrokenStatesAreRefusedWithAReason) {
  const SquareDrive drive(4);
  const ClassTable classes = makeStreetClasses();
  const SlamConfig config = defaultsOf(Method::kDpmhm);
  Slam slam(config, classes);
  drive.feed(slam, 0, 200);
  const SlamState good = slam.snapshot();
  for (std::size_t i = 0; i < good.sections.size(); ++i) {
    SlamState state = good;
    state.sections[i].bytes.resize(state.sections[i].bytes.size() / 2);
    expectInputError([&] { Slam(config, classes, state); }, {"broken state"});
    state = good;
    state.sections[i].bytes.push_back('x');
    expectInputError([&] { Slam(config, classes, state); }, {"1 bytes too many"});
    state = good;
    const int newer = ++state.sections[i].version;
    expectInputError([&] { Slam(config, classes, state); },
                     {"section '" + good.sections[i].name, "has version " + std::to_string(newer)});
    state.source = "town/map.bag";
    expectInputError([&] { Slam(config, classes, state); }, {"town/map.bag: the section '", "has version "});
    state = good;
    state.sections.erase(state.sections.begin() + static_cast<std::ptrdiff_t>(i));
    expectInputError([&] { Slam(config, classes, state); }, {good.sections[i].name, "missing"});
  }
}

TEST(SlamStateErrorTest, ReadingCanBeGivenUpAtAnyTime) {
  const SquareDrive drive(4);
  const ClassTable classes = makeStreetClasses();
  const SlamConfig config = defaultsOf(Method::kDpmhm);
  Slam slam(config, classes);
  drive.feed(slam, 0, 200);
  const SlamState state = slam.snapshot();
  int asked = 0;
  Slam(config, classes, state, [&] { return ++asked > 0; });
  ASSERT_GT(asked, 100) << "asked too seldom to be quick";
  for (int last = 1; last < asked; last += asked / 20) {
    int so_far = 0;
    expectInputError([&] { Slam(config, classes, state, [&] { return ++so_far < last; }); }, {"given up"});
    EXPECT_EQ(so_far, last) << "went on after it was told to give up";
  }
}

TEST(SlamStateErrorTest, AnotherMethodOrAnotherGraphIsRefused) {
  const ClassTable classes = makeStreetClasses();
  SlamConfig config = defaultsOf(Method::kDpmhm);
  const SlamState state = Slam(config, classes).snapshot();
  expectInputError([&] { Slam(defaultsOf(Method::kUkf), classes, state); }, {"'dpmhm'", "'ukf'"});
  config.back_end.graph.chunk_nodes += 1;
  expectInputError([&] { Slam(config, classes, state); }, {"graph.chunk_nodes 10"});
}

TEST(SlamStateErrorTest, RandomDamageNeverDoesMoreThanBeRefused) {
  const SquareDrive drive(5);
  const ClassTable classes = makeStreetClasses();
  const SlamConfig config = defaultsOf(Method::kDpmhm);
  Slam slam(config, classes);
  drive.feed(slam, 0, 130);
  const SlamState good = slam.snapshot();
  Rng rng(6);
  int refused = 0;
  for (int trial = 0; trial < 300; ++trial) {
    SlamState state = good;
    std::string& bytes = state.sections[rng.index(state.sections.size())].bytes;
    bytes[rng.index(bytes.size())] = static_cast<char>(rng.index(256));
    try {
      Slam damaged(config, classes, state);
    } catch (const InputError&) {
      ++refused;
    } catch (const std::invalid_argument&) {
      ++refused;  // numbers that no estimate can have
    }
  }
  EXPECT_GT(refused, 0);
}

}  // namespace
}  // namespace semantic_mht_slam
