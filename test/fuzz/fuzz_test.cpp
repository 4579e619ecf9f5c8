// What the fuzzers run, with a few inputs that are always the same: seeds, and seeds with some things changed. More
// with SMHT_FUZZ_FACTOR.
#include <cstdlib>
#include <iostream>

#include <gtest/gtest.h>

#include "fuzz/fuzz_target.h"
#include "support/state_mutation.h"

namespace semantic_mht_slam {
namespace {

struct FuzzCase {
  FuzzTarget (*target)();
  int inputs;
};

class FuzzTest : public testing::TestWithParam<FuzzCase> {};

TEST_P(FuzzTest, ChangedSeedsAreRefusedOrTaken) {
  const FuzzTarget target = GetParam().target();
  ASSERT_FALSE(target.seeds.empty());
  for (const std::string& seed : target.seeds) EXPECT_TRUE(target.run(seed)) << target.name << " refuses a good one";
  const char* factor = std::getenv("SMHT_FUZZ_FACTOR");
  const int wanted = GetParam().inputs * (factor == nullptr ? 1 : std::atoi(factor));
  int executed = 0;
  int taken = 0;
  for (int i = 0; i < wanted; ++i) {
    Rng rng = Rng(5).fork(target.name, static_cast<std::uint64_t>(i));
    std::string bytes = target.seeds[rng.index(target.seeds.size())];
    for (std::size_t changes = 1 + rng.index(4); changes > 0; --changes) {
      const bool as_it_likes = target.mutate && rng.bernoulli(0.5);
      bytes = as_it_likes ? target.mutate(std::move(bytes), rng) : mutated(std::move(bytes), rng);
    }
    EXPECT_NO_THROW(taken += target.run(bytes) ? 1 : 0) << target.name << ", input " << i;
    ++executed;
  }
  EXPECT_EQ(executed, wanted);
  EXPECT_GT(taken, 0) << "what is refused at once tests nothing";
  std::cout << target.name << ": " << taken << " of " << executed << " were taken\n";
}

INSTANTIATE_TEST_SUITE_P(Targets, FuzzTest,
                         testing::Values(FuzzCase{csvTarget, 3000}, FuzzCase{estimatorTarget, 60},
                                         FuzzCase{g2oTarget, 3000}, FuzzCase{mapSectionTarget, 300},
                                         FuzzCase{mapStateTarget, 20}, FuzzCase{mapUpdateTarget, 60},
                                         FuzzCase{messagesTarget, 100}, FuzzCase{scanTarget, 500},
                                         FuzzCase{trajectoryTarget, 3000}, FuzzCase{treeTarget, 300},
                                         FuzzCase{yamlTarget, 500}),
                         [](const auto& instance) { return instance.param.target().name; });

}  // namespace
}  // namespace semantic_mht_slam
