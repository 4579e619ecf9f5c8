#include "semantic_mht_slam/map/identity.h"

#include <memory>

#include <gtest/gtest.h>

#include "semantic_mht_slam/common/random.h"
#include "semantic_mht_slam/common/state_archive.h"

namespace semantic_mht_slam {
namespace {

using Kind = IdentityEvent::Kind;
using Names = std::vector<LandmarkId>;

/// A submap of one frame for each of these lists of landmarks.
Submap submapOf(std::size_t id, const std::vector<Names>& frames) {
  Submap submap;
  submap.id = SubmapId(id);
  for (std::size_t f = 0; f < frames.size(); ++f) {
    int row = 0;
    for (const LandmarkId landmark : frames[f]) submap.associations.push_back({100 * id + f, row++, landmark});
  }
  return submap;
}

ClosureId closure(std::size_t index) {
  return ClosureId(index);
}

TEST(IdentityTest, ALandmarkIsWhatTheSayingsJoinAndGoesByItsOldestName) {
  Identity identity;
  Submap submap = submapOf(0, {{3}, {4}});
  submap.duplicates = {{4, 3}};
  identity.add(submap);
  identity.add(closure(0), {{9, 4}});
  EXPECT_EQ(identity.landmarkOf(9), 9U) << "nothing holds before it is decided";
  identity.decide({{closure(0), true}});
  for (const LandmarkId name : {3U, 4U, 9U}) EXPECT_EQ(identity.landmarkOf(name), 3U);
  EXPECT_EQ(identity.landmarkOf(5), 5U) << "never heard of";
  EXPECT_EQ(identity.namesOf(3), (Names{3, 4, 9}));
  EXPECT_EQ(identity.namesOf(5), Names{5});
}

TEST(IdentityTest, AClosureThatFallsTakesItsSayingsWithItAndOthersStay) {
  Identity identity;
  identity.add(submapOf(0, {{1}, {2}, {3}}));
  identity.add(closure(0), {{11, 1}, {12, 2}});
  identity.add(closure(1), {{12, 2}, {13, 3}});
  identity.decide({{closure(0), true}, {closure(1), true}});
  identity.takeChanges();
  identity.decide({{closure(0), false}});
  EXPECT_EQ(identity.landmarkOf(11), 11U);
  EXPECT_EQ(identity.landmarkOf(12), 2U) << "the other closure says so, too";
  EXPECT_EQ(identity.takeChanges(), (std::vector<Names>{{1}, {11}}));
  ASSERT_EQ(identity.ledger().size(), 4U);
  const IdentityEvent& split = identity.ledger().back();
  EXPECT_EQ(split.kind, Kind::kSplit);
  EXPECT_EQ(split.closure, closure(0));
  EXPECT_EQ(split.a, 11U);
  EXPECT_EQ(split.b, 1U);
  identity.decide({{closure(0), true}});
  EXPECT_EQ(identity.landmarkOf(11), 1U);
  EXPECT_EQ(identity.ledger().back().kind, Kind::kMerged);
}

TEST(IdentityTest, WhatAFrameShowsSideBySideIsNeverOneNotEvenByOtherNames) {
  Identity identity;
  identity.add(submapOf(0, {{1, 2}}));
  identity.add(submapOf(1, {{11}, {12}}));
  identity.add(closure(0), {{11, 1}, {11, 2}, {12, 2}, {12, 11}});
  identity.decide({{closure(0), true}});
  EXPECT_EQ(identity.namesOf(1), (Names{1, 11}));
  EXPECT_EQ(identity.namesOf(2), (Names{2, 12})) << "11 and 12 are apart because 1 and 2 are";
  EXPECT_EQ(identity.ledger()[1].kind, Kind::kKeptApart);
}

TEST(IdentityTest, PartsOfOneObjectMayBeOne) {
  Identity identity;
  Submap submap = submapOf(0, {{1, 2}, {1, 2}});
  submap.near = {{1, 2, 2}};
  identity.add(submap);
  identity.add(closure(0), {{1, 2}});
  identity.decide({{closure(0), true}});
  EXPECT_EQ(identity.landmarkOf(2), 1U);
  Submap later = submapOf(1, {{1, 2}, {1, 2}});
  later.near = {{1, 2, 1}};  // and once further apart than parts are
  identity.add(later);
  EXPECT_EQ(identity.landmarkOf(2), 2U);
  EXPECT_EQ(identity.ledger().back().kind, Kind::kKeptApart);
}

TEST(IdentityTest, ALaterFrameThatShowsBothSplitsAgain) {
  Identity identity;
  identity.add(submapOf(0, {{1}, {2}}));
  identity.add(closure(0), {{1, 2}, {2, 3}});
  identity.decide({{closure(0), true}});
  ASSERT_EQ(identity.namesOf(1), (Names{1, 2, 3}));
  identity.takeChanges();
  identity.add(submapOf(1, {{1, 2}}));
  EXPECT_EQ(identity.landmarkOf(2), 2U);
  EXPECT_EQ(identity.namesOf(2), (Names{2, 3}));
  EXPECT_EQ(identity.takeChanges(), (std::vector<Names>{{1}, {2, 3}}));
}

/// Random submaps and closures, and decisions that change again and again.
class RandomIdentityTest : public testing::TestWithParam<std::uint64_t> {
 protected:
  void drive() {
    Rng rng(GetParam());
    for (std::size_t s = 0; s < 25; ++s) {
      Submap submap = submapOf(s, randomFrames(s, rng));
      submap.duplicates = {{name(s, rng), name(s, rng)}};
      identity_.add(submap);
      submaps_.push_back(std::make_shared<const Submap>(submap));
      for (int c = 0; c < 3; ++c) {
        const ClosureId id(pairs_.size());
        pairs_.push_back({{name(s, rng), name(0, rng)}, {name(s, rng), name(s / 2, rng)}});
        submap_of_.push_back(SubmapId(s));
        identity_.add(id, pairs_.back());
        holds_.push_back(rng.bernoulli(0.8));
        identity_.decide({{id, holds_.back() != 0}});
      }
      const std::size_t changed = rng.index(pairs_.size());
      holds_[changed] = !holds_[changed];
      identity_.decide({{ClosureId(changed), holds_[changed] != 0}});
    }
  }

  static LandmarkId name(std::size_t submap, Rng& rng) { return 1 + 10 * submap + rng.index(10); }

  static std::vector<Names> randomFrames(std::size_t submap, Rng& rng) {
    std::vector<Names> frames(6);
    for (Names& names : frames) {
      for (int i = 0; i < 2; ++i) names.push_back(name(submap - std::min<std::size_t>(submap, rng.index(2)), rng));
      if (names[0] == names[1]) names.pop_back();
    }
    return frames;
  }

  Identity identity_;
  IdVector<SubmapId, std::shared_ptr<const Submap>> submaps_;
  std::vector<std::vector<SameLandmark>> pairs_;
  std::vector<SubmapId> submap_of_;
  std::vector<char> holds_;
};

TEST_P(RandomIdentityTest, TheResultDependsOnWhatHoldsNotOnHowItCameToBe) {
  drive();
  std::vector<Identity::Saying> sayings;
  for (std::size_t c = 0; c < pairs_.size(); ++c) {
    sayings.push_back({submap_of_[c], {ClosureId(c), holds_[c] != 0}, &pairs_[c]});
  }
  StateArchive writing;
  identity_.transfer(writing);
  Identity again;
  const std::string reading_bytes = writing.written();
  StateArchive reading(reading_bytes);
  again.transfer(reading);
  again.restore(submaps_, sayings);
  int merged = 0;
  for (LandmarkId id = 1; id <= 250; ++id) {
    EXPECT_EQ(again.landmarkOf(id), identity_.landmarkOf(id)) << id;
    merged += identity_.landmarkOf(id) != id;
  }
  EXPECT_GT(merged, 20);
  EXPECT_EQ(again.takeChanges(), identity_.takeChanges());
  EXPECT_EQ(again.ledger().size(), identity_.ledger().size());
}

TEST_P(RandomIdentityTest, NoLandmarkHasTwoNamesThatAFrameShowsSideBySide) {
  drive();
  for (const auto& submap : submaps_) {
    for (const DetectionAssociation& a : submap->associations) {
      for (const DetectionAssociation& b : submap->associations) {
        if (a.frame != b.frame || a.landmark == b.landmark) continue;
        EXPECT_NE(identity_.landmarkOf(a.landmark), identity_.landmarkOf(b.landmark));
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomIdentityTest, testing::Range<std::uint64_t>(1, 9));

}  // namespace
}  // namespace semantic_mht_slam
