#include "semantic_mht_slam/slam/map_delta.h"

#include <limits>

#include <gtest/gtest.h>

#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/merging/map_merger.h"
#include "semantic_mht_slam/slam/surroundings.h"

#include "support/square_drive.h"

namespace semantic_mht_slam {
namespace {

const SlamConfig kConfig = defaultsOf(Method::kDpmhm);

MapByDeltas deltasOf(const SlamParts& parts) {
  MapByDeltas map;
  map.range_factor = parts.range_factor;
  for (const SubmapId id : parts.map.submaps().ids()) map.deltas.push_back(deltaOf(parts, id));
  map.held = heldClosures(parts.map);
  return map;
}

/// A drive of more than a round, so that it closes loops.
class MapDeltaTest : public testing::Test {
 protected:
  void SetUp() override {
    SquareDrive(3).feed(slam_, 0, 640);
    slam_.finish();
  }

  const ClassTable classes_ = makeStreetClasses();
  Slam slam_{kConfig, classes_};
};

TEST_F(MapDeltaTest, DeltasGiveTheMapAgain) {
  const SlamParts again = makeMap(deltasOf(slam_.parts()), kConfig, classes_);
  const Map& map = slam_.map();
  ASSERT_EQ(again.map.submaps().size(), map.submaps().size());
  ASSERT_EQ(again.map.keyframes().size(), map.keyframes().size());
  double largest_m = 0.0;
  for (const KeyframeId k : map.keyframes().ids()) {
    const Eigen::Vector3d apart_m = again.map.T_map_keyframe(k).translation_m - map.T_map_keyframe(k).translation_m;
    largest_m = std::max(largest_m, apart_m.norm());
  }
  EXPECT_LT(largest_m, 0.2);
  std::size_t kept = 0;
  std::size_t found = 0;
  std::size_t in_again = 0;
  again.map.forEachLandmark([&](SubmapId, const MixtureLandmark&) { ++in_again; });
  map.forEachLandmark([&](SubmapId, const MixtureLandmark& landmark) {
    ++kept;
    found += again.map.find(landmark.id) &&
             again.map.find(landmark.id)->second.mostLikelyClass() == landmark.mostLikelyClass();
  });
  EXPECT_EQ(found, kept);
  EXPECT_EQ(in_again, kept);
}

TEST_F(MapDeltaTest, RefusedClosuresStayRefused) {
  MapByDeltas map = deltasOf(slam_.parts());
  ASSERT_GT(std::count(map.held.begin(), map.held.end(), true), 3);
  map.held.assign(map.held.size(), false);
  const SlamParts again = makeMap(map, kConfig, classes_);
  for (const LoopClosureRecord& closure : again.map.closures()) EXPECT_FALSE(closure.is_accepted);
}

TEST_F(MapDeltaTest, AMapByDeltasIsJoinedLikeTheMap) {
  Slam other(kConfig, classes_);
  const SquareDrive square(3);
  for (int i = 700; i < 1100; ++i) {
    other.addOdometry({SquareDrive::stampAt(i), SquareDrive::odometryAt(i)});
    other.addDetections(SquareDrive::stampAt(i) - 30000000, square.detectionsAt(i));
  }
  other.finish();
  const SlamParts again = makeMap(deltasOf(slam_.parts()), kConfig, classes_);
  const auto merged = [&](const MergeMap& first) {
    std::vector<MergeMap> maps{first, MergeMap("other", other)};
    const MergeResult result = mergeMaps(maps, kConfig, classes_);
    EXPECT_TRUE(result.pairs[0].is_joined) << result.pairs[0].reason;
    return landmarksOf(*result.groups[0].joined).size();
  };
  const auto of_state = static_cast<double>(merged(MergeMap("map", slam_)));
  const auto of_deltas = static_cast<double>(merged(MergeMap("map", again)));
  EXPECT_NEAR(of_deltas, of_state, 0.02 * of_state);
}

void expectSamePlaces(const Map& a, const Map& b, double most_m) {
  ASSERT_EQ(a.keyframes().size(), b.keyframes().size());
  for (const KeyframeId k : a.keyframes().ids()) {
    const Eigen::Vector3d apart_m = a.T_map_keyframe(k).translation_m - b.T_map_keyframe(k).translation_m;
    EXPECT_LT(apart_m.norm(), most_m) << k.index();
  }
}

TEST_F(MapDeltaTest, AnotherSessionBeginsWhereItWasFound) {
  slam_.beginSession();
  const SquareDrive square(3);
  const Pose elsewhere{expRotation({0.0, 0.0, 2.0}), {300.0, -200.0, 0.0}};
  for (int i = 700; i < 1000; ++i) {
    slam_.addOdometry({SquareDrive::stampAt(i), elsewhere * SquareDrive::odometryAt(i)});
    slam_.addDetections(SquareDrive::stampAt(i) - 30000000, square.detectionsAt(i));
  }
  slam_.finish();
  const MapByDeltas map = deltasOf(slam_.parts());
  EXPECT_EQ(std::count_if(map.deltas.begin(), map.deltas.end(), [](const MapDelta& one) { return one.begins_session; }),
            1);
  expectSamePlaces(makeMap(map, kConfig, classes_).map, slam_.map(), 0.5);
}

TEST_F(MapDeltaTest, AJoinedMapOfDrivesAtOneTimeIsMadeAgain) {
  Slam other(kConfig, classes_);
  const SquareDrive square(3);
  for (int i = 700; i < 1100; ++i) {
    other.addOdometry({SquareDrive::stampAt(i - 700), SquareDrive::odometryAt(i)});
    other.addDetections(SquareDrive::stampAt(i - 700) - 30000000, square.detectionsAt(i));
  }
  other.finish();
  std::vector<MergeMap> maps{MergeMap("map", slam_), MergeMap("other", other)};
  const MergeResult result = mergeMaps(maps, kConfig, classes_);
  const SlamParts& joined = result.groups[0].joined->parts;
  ASSERT_EQ(joined.map.keyframes().size(), slam_.map().keyframes().size() + other.map().keyframes().size());
  const Slam again(kConfig, classes_, makeState(deltasOf(joined), kConfig, classes_));
  expectSamePlaces(again.map(), joined.map, 1.0);
}

TEST_F(MapDeltaTest, DeltasThatContradictThemselvesAreRefused) {
  const MapByDeltas good = deltasOf(slam_.parts());
  const auto expectRefused = [&](const std::function<void(MapByDeltas&)>& change) {
    MapByDeltas bad = good;
    change(bad);
    EXPECT_THROW(makeMap(bad, kConfig, classes_), InputError);
  };
  expectRefused([](MapByDeltas& map) { map.deltas.clear(); });
  expectRefused([](MapByDeltas& map) { map.deltas[0].keyframes.clear(); });
  expectRefused([](MapByDeltas& map) { map.deltas[0].keyframes[0].landmarks[0] = 1000000; });
  expectRefused([](MapByDeltas& map) {
    std::vector<std::size_t>& landmarks = map.deltas[0].keyframes[0].landmarks;
    landmarks.push_back(landmarks.front());
  });
  expectRefused([](MapByDeltas& map) { map.deltas[0].landmarks[0].position.cov_m2(0, 0) *= -1.0; });
  expectRefused([](MapByDeltas& map) {
    map.deltas.back().keyframes.back().driven.way_m = std::numeric_limits<double>::infinity();
  });
  expectRefused([](MapByDeltas& map) { std::swap(map.deltas[0].landmarks[0], map.deltas[0].landmarks[1]); });
  expectRefused([](MapByDeltas& map) { map.deltas[0].landmarks[0].keyframe = 1000000; });
  expectRefused([](MapByDeltas& map) {
    LoopClosureRecord closure;
    closure.query_keyframe = KeyframeId(100000);
    closure.match_keyframe = KeyframeId(0);
    map.deltas[0].closures.push_back(closure);
  });
}

}  // namespace
}  // namespace semantic_mht_slam
