#include "semantic_mht_slam/merging/map_merger.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/common/random.h"
#include "semantic_mht_slam/slam/slam_parts_state.h"
#include "semantic_mht_slam/slam/surroundings.h"

#include "support/square_drive.h"

namespace semantic_mht_slam {
namespace {

constexpr int kRound = 480;

/// A drive through the square of `world` from frame `begin` on, whose odometry begins anywhere.
struct Drive {
  Drive(std::uint64_t world, int begin, int end) : square(world), first(begin) {
    Rng rng(world * 1000 + static_cast<std::uint64_t>(begin));
    T_start = {expRotation({0.0, 0.0, rng.uniform(-M_PI, M_PI)}),
               {rng.uniform(-500.0, 500.0), rng.uniform(-500.0, 500.0), rng.uniform(-5.0, 5.0)}};
    T_start = T_start * SquareDrive::odometryAt(begin).inverse();
    feed(slam, begin, end);
    slam.finish();
  }

  void feed(Slam& to, int begin, int end) const {
    for (int i = begin; i < end; ++i) {
      to.addOdometry({SquareDrive::stampAt(i), T_start * SquareDrive::odometryAt(i)});
      to.addDetections(SquareDrive::stampAt(i) - 30000000, square.detectionsAt(i));
    }
  }

  SquareDrive square;
  int first;
  Pose T_start;
  ClassTable classes = makeStreetClasses();
  Slam slam{defaultsOf(Method::kDpmhm), classes};
};

MergeResult merge(const std::vector<const Drive*>& drives, std::vector<MergeMap>& maps) {
  maps.clear();
  for (std::size_t i = 0; i < drives.size(); ++i) maps.emplace_back("map" + std::to_string(i), drives[i]->slam);
  return mergeMaps(maps, defaultsOf(Method::kDpmhm), drives.front()->classes);
}

/// Largest error of the place of a keyframe of `b` as the nearest one of `a` has it.
double largestError_m(const JoinedMap& joined, const Drive& a, const Drive& b) {
  const std::size_t first_b = joined.members[1].first_keyframe;
  const auto& keyframes = joined.parts.map.keyframes();
  double largest_m = 0.0;
  for (std::size_t k = first_b; k < keyframes.size(); ++k) {
    const KeyframeId in_b(k);
    const std::size_t frame_b = b.slam.map().keyframes()[KeyframeId(k - first_b)].frame;
    const Pose true_b = b.square.truthAt(b.first + static_cast<int>(frame_b));
    double nearest_m = 1e9;
    Pose T_a_b;
    Pose true_a_b;
    for (std::size_t i = 0; i < first_b; ++i) {
      const KeyframeId in_a(i);
      const Pose true_a = a.square.truthAt(a.first + static_cast<int>(keyframes[in_a].frame));
      const double apart_m = (true_a.translation_m - true_b.translation_m).norm();
      if (apart_m >= nearest_m) continue;
      nearest_m = apart_m;
      T_a_b = joined.parts.map.T_map_keyframe(in_a).inverse() * joined.parts.map.T_map_keyframe(in_b);
      true_a_b = true_a.inverse() * true_b;
    }
    if (nearest_m > 5.0) continue;
    largest_m = std::max(largest_m, (T_a_b.translation_m - true_a_b.translation_m).head<2>().norm());
  }
  return largest_m;
}

std::vector<MixtureLandmark> landmarksIn(const SlamParts& parts) {
  return landmarksOf(parts.map, parts.graph, uncertaintyOf(parts.map, parts.graph, {parts.start_cov, 0.0}));
}

/// Share of the landmarks that stand within half a metre of another one of their class.
double duplicateShare(const std::vector<MixtureLandmark>& landmarks) {
  int twice = 0;
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const bool is_one_class = landmarks[i].mostLikelyClass() == landmarks[k].mostLikelyClass();
      const double apart_m = (landmarks[i].position.mean_m - landmarks[k].position.mean_m).head<2>().norm();
      if (!is_one_class || apart_m > 0.5) continue;
      ++twice;
      break;
    }
  }
  return static_cast<double>(twice) / static_cast<double>(landmarks.size());
}

class OneWorld : public testing::TestWithParam<int> {};

TEST_P(OneWorld, TwoDrivesBecomeOneMap) {
  const auto world = static_cast<std::uint64_t>(GetParam());
  const Drive a(world, 0, 400);
  const Drive b(world, kRound + 200, kRound + 620);
  std::vector<MergeMap> maps;
  const MergeResult result = merge({&a, &b}, maps);
  ASSERT_EQ(result.pairs.size(), 1U);
  EXPECT_TRUE(result.pairs[0].is_joined) << result.pairs[0].reason;
  EXPECT_GE(result.pairs[0].posterior, 0.999);
  EXPECT_GE(result.pairs[0].closures, 5);
  ASSERT_EQ(result.groups.size(), 1U);
  ASSERT_TRUE(result.groups[0].joined);
  const JoinedMap& joined = *result.groups[0].joined;
  EXPECT_LT(largestError_m(joined, a, b), 0.3);
  const auto landmarks = landmarksIn(joined.parts);
  EXPECT_LE(duplicateShare(landmarks), 0.05);
  EXPECT_GT(landmarks.size(), landmarksOf(a.slam).size() * 9 / 10);
  // Both names of a landmark that is one lead to it.
  const LandmarkId offset = joined.members[1].landmark_offset;
  int shared = 0;
  for (const MixtureLandmark& landmark : landmarks) {
    const bool has_both = landmark.id <= offset && !landmark.merged_ids.empty() && landmark.merged_ids.back() > offset;
    if (!has_both) continue;
    ++shared;
    EXPECT_EQ(joined.parts.map.identity().landmarkOf(landmark.merged_ids.back()), landmark.id);
  }
  EXPECT_GT(shared, 30);
}

INSTANTIATE_TEST_SUITE_P(Seeds, OneWorld, testing::Values(1, 2, 3));

TEST(MapMergerTest, MergingTwiceGivesTheSame) {
  const Drive a(1, 0, 300);
  const Drive b(1, kRound, kRound + 300);
  std::vector<MergeMap> maps;
  const MergeResult first = merge({&a, &b}, maps);
  const MergeResult second = merge({&a, &b}, maps);
  ASSERT_TRUE(first.groups[0].joined && second.groups[0].joined);
  const SlamConfig config = defaultsOf(Method::kDpmhm);
  const SlamState x = stateOf(config, first.groups[0].joined->parts);
  const SlamState y = stateOf(config, second.groups[0].joined->parts);
  for (std::size_t i = 0; i < x.sections.size(); ++i) EXPECT_TRUE(x.sections[i].bytes == y.sections[i].bytes);
}

TEST(MapMergerTest, DrivesThroughDifferentWorldsStayApart) {
  for (const std::uint64_t world : {1U, 3U, 5U}) {
    const Drive a(world, 0, 400);
    const Drive b(world + 1, 100, 500);
    std::vector<MergeMap> maps;
    const MergeResult result = merge({&a, &b}, maps);
    EXPECT_FALSE(result.pairs[0].is_joined) << world;
    EXPECT_FALSE(result.pairs[0].reason.empty());
    EXPECT_EQ(result.groups.size(), 2U);
    EXPECT_FALSE(result.reasons[0].empty());
    EXPECT_FALSE(result.reasons[1].empty());
  }
}

TEST(MapMergerTest, ADriveThatOverlapsNothingIsAnIsland) {
  const Drive a(1, 0, 300);
  const Drive elsewhere(9, 0, 300);
  const Drive b(1, kRound + 100, kRound + 400);
  std::vector<MergeMap> maps;
  const MergeResult result = merge({&a, &elsewhere, &b}, maps);
  ASSERT_EQ(result.groups.size(), 2U);
  EXPECT_EQ(result.groups[0].maps, (std::vector<std::size_t>{0, 2}));
  EXPECT_EQ(result.groups[1].maps, (std::vector<std::size_t>{1}));
  EXPECT_TRUE(result.reasons[0].empty());
  EXPECT_FALSE(result.reasons[1].empty());
}

TEST(MapMergerTest, ASessionFindsItselfInTheJoinedMapAndGoesOn) {
  const Drive a(2, 0, 400);
  const Drive b(2, kRound + 200, kRound + 620);
  std::vector<MergeMap> maps;
  const MergeResult result = merge({&a, &b}, maps);
  ASSERT_TRUE(result.groups[0].joined);
  const JoinedMap& joined = *result.groups[0].joined;
  const SlamConfig config = defaultsOf(Method::kDpmhm);
  Slam slam(config, a.classes, stateOf(config, joined.parts));
  const std::size_t landmarks = landmarksOf(slam).size();
  const std::size_t keyframes = slam.map().keyframes().size();
  const std::size_t samples = trajectoryOf(slam).size();
  EXPECT_EQ(samples, 400U + 420U);
  EXPECT_EQ(landmarks, landmarksIn(joined.parts).size());

  Drive again(2, 2 * kRound + 50, 2 * kRound + 51);  // for its odometry alone
  again.feed(slam, 2 * kRound + 50, 2 * kRound + 350);
  slam.finish();
  EXPECT_EQ(trajectoryOf(slam).size(), samples + 300U);
  EXPECT_GT(slam.map().keyframes().size(), keyframes + 30);
  EXPECT_LT(landmarksOf(slam).size(), landmarks + landmarks / 20);
  const auto sessions = slam.parts().sessions.summary(slam.map());
  ASSERT_EQ(sessions.size(), 3U);
  for (const SessionSummary& session : sessions) EXPECT_TRUE(session.is_located);
}

TEST(MapMergerTest, AClosureBetweenMapsThatIsTakenBackTakesItsPairsAlong) {
  const Drive a(1, 0, 300);
  const Drive b(2, 0, 300);
  std::vector<MergeMap> maps;
  maps.emplace_back("a", a.slam);
  maps.emplace_back("b", b.slam);
  const MergeSettings settings = mergeSettings(maps, defaultsOf(Method::kDpmhm), a.classes);
  const auto closure = [&](std::size_t query, std::size_t match, double offset_m) {
    LoopClosureRecord record;
    record.query_keyframe = KeyframeId(query);
    record.match_keyframe = KeyframeId(match);
    record.is_verified = true;
    record.T_match_query = {Eigen::Quaterniond::Identity(), {offset_m, 0.0, 0.0}};
    record.cov = 0.01 * PoseCov::Identity();
    record.pairs = {{b.slam.map().keyframes()[KeyframeId(query)].scene.objects.front().landmark,
                     a.slam.map().keyframes()[KeyframeId(match)].scene.objects.front().landmark}};
    return CrossClosure{1, 0, record};
  };
  const JoinedMap joined =
      joinMaps({{&maps[0], Pose::identity()}, {&maps[1], Pose::identity()}},
               {closure(2, 2, 0.0), closure(6, 6, 0.0), closure(10, 10, 0.0), closure(20, 20, 25.0)}, settings);
  int held = 0;
  for (const LoopClosureRecord& record : joined.parts.map.closures()) {
    if (!record.is_verified || record.query_keyframe.index() < joined.members[1].first_keyframe) continue;
    if (record.match_keyframe.index() >= joined.members[1].first_keyframe) continue;
    const bool is_wrong = record.match_keyframe == KeyframeId(20);
    EXPECT_EQ(record.is_accepted, !is_wrong);
    const LandmarkId second = joined.parts.map.identity().landmarkOf(record.pairs.front().first);
    const LandmarkId first = joined.parts.map.identity().landmarkOf(record.pairs.front().second);
    EXPECT_EQ(first == second, !is_wrong);
    ++held;
  }
  EXPECT_EQ(held, 4);
}

TEST(MapMergerTest, AMapWithoutSubmapsIsRefused) {
  const ClassTable classes = makeStreetClasses();
  const Slam empty(defaultsOf(Method::kDpmhm), classes);
  std::vector<MergeMap> maps;
  maps.emplace_back("empty", empty);
  EXPECT_THROW(mergeMaps(maps, defaultsOf(Method::kDpmhm), classes), InputError);
}

}  // namespace
}  // namespace semantic_mht_slam
