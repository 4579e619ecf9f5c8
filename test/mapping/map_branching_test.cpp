#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "semantic_mht_slam/map/identity.h"
#include "semantic_mht_slam/mapping/mapper.h"

#include "mapping/mapper_test_util.h"

namespace semantic_mht_slam {
namespace {

constexpr int kFrames = 58;
constexpr double kFar_m =
    1000.0;  // between the first and the second pass in the odometry, so that nothing is carried on
constexpr double kRange_m = 28.0;

ClassTable makeMapTable() {
  std::vector<ClassInfo> classes(2);
  classes[0].name = "pole";
  classes[1].name = "trunk";
  classes[1].id = 1;
  return ClassTable(classes, "test");
}

struct Object {
  Eigen::Vector3d position_m;
  ClassIndex class_index = 0;
};

/// Poles and trunks at irregular places along a street.
std::vector<Object> street(std::uint64_t seed) {
  Rng rng(seed);
  std::vector<Object> objects;
  for (int i = 0; i < 40; ++i) {
    const double side = i % 2 == 0 ? 1.0 : -1.0;
    objects.push_back({{rng.uniform(-20.0, 80.0), side * rng.uniform(4.0, 12.0), rng.uniform(-0.5, 0.5)},
                       static_cast<ClassIndex>(rng.index(2))});
  }
  return objects;
}

struct Options {
  Pose T_earlier_submap;       ///< drift of the second pass: true pose of its submaps in their predicted frame
  bool is_same_street = true;  ///< or the second pass sees another one
  bool is_reversed = false;    ///< the earlier map's landmarks and the detections in another order
  double twin_from_m = 0.0;    ///< not 0: the earlier map has a second street beside, which is the same up to here
  double stddev_xy_m = 3.0;
};

struct Passes {
  std::vector<FinishedSubmap> first;
  std::vector<FinishedSubmap> second;
  std::map<std::size_t, std::vector<int>> truth;  ///< true object of each row, by frame
  std::size_t most_alignments = 0;                ///< distinct ones alive together in the second pass
  std::vector<double> both_alive_m;               ///< distances at which two alignments were alive
};

Detections detect(const std::vector<Object>& objects, double x_m, const Options& options, Rng& rng,
                  std::vector<int>& truth) {
  Detections detections;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const Eigen::Vector3d relative_m = objects[i].position_m - Eigen::Vector3d(x_m, 0.0, 0.0);
    if (relative_m.norm() > kRange_m || !rng.bernoulli(0.75)) continue;
    Detection detection;
    detection.class_index = objects[i].class_index;
    detection.position_m = relative_m + 0.05 * Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal());
    detection.row = static_cast<int>(truth.size());
    truth.push_back(static_cast<int>(i));
    detections.push_back(detection);
  }
  if (options.is_reversed) std::reverse(detections.begin(), detections.end());
  return detections;
}

/// The first pass's landmarks in the odometry frame.
std::vector<MixtureLandmark> landmarksOf(const std::vector<FinishedSubmap>& submaps) {
  std::map<LandmarkId, MixtureLandmark> by_id;
  for (const auto& [submap, frames, alignment, unsure] : submaps) {
    for (MixtureLandmark landmark : submap.landmarks) {
      landmark.position.mean_m = submap.T_odom_submap * landmark.position.mean_m;
      by_id[landmark.id] = landmark;
    }
  }
  std::vector<MixtureLandmark> result;
  for (const auto& [id, landmark] : by_id) {
    if (landmark.existence_prob > 0.5) result.push_back(landmark);
  }
  return result;
}

/// A second street 6 m to the right, which is the first one up to `twin_from_m` and then another one.
void addTwin(double twin_from_m, std::vector<MixtureLandmark>& landmarks) {
  const std::size_t count = landmarks.size();
  Rng rng(99);
  for (std::size_t i = 0; i < count; ++i) {
    MixtureLandmark twin = landmarks[i];
    twin.id = 500000 + twin.id;
    if (twin.position.mean_m.x() > twin_from_m) {
      twin.position.mean_m.head<2>() += Eigen::Vector2d(rng.uniform(-3.0, 3.0), rng.uniform(-3.0, 3.0));
    }
    twin.position.mean_m.y() -= 3.0;
    landmarks[i].position.mean_m.y() += 3.0;
    landmarks.push_back(twin);
  }
}

std::size_t distinctAlignments(const std::vector<MapHypothesis>& leaves) {
  std::set<int> sides;
  for (const MapHypothesis& leaf : leaves) {
    if (leaf.map_offset) sides.insert(static_cast<int>(std::lround(leaf.map_offset->mean.y())));
  }
  return sides.size();
}

/// So far that no landmark of the first pass is carried on.
void driveThroughNothing(Mapper& mapper, Rng& rng) {
  for (int i = 0; i < 20; ++i) {
    const Pose T_odom_base{Eigen::Quaterniond::Identity(), {100.0 + 10.0 * i, 0.0, 0.0}};
    feed(mapper, {1000 + static_cast<std::size_t>(i), 1000 + i, T_odom_base, {}}, rng);
  }
  EXPECT_TRUE(mapper.finish().submap.landmarks.empty());
}

Passes drive(std::uint64_t seed, const Options& options, const MapperConfig& config = {}) {
  Mapper mapper(config, makeMapTable());
  Passes passes;
  const std::vector<Object> first_street = street(seed);
  const std::vector<Object> second_street = options.is_same_street ? first_street : street(seed + 1000);
  const auto earlier_map = [&](const Pose& T_odom_submap) {
    EarlierMap map;
    if (T_odom_submap.translation_m.x() < 0.5 * kFar_m) return map;
    map.landmarks = landmarksOf(passes.first);
    if (options.twin_from_m > 0.0) addTwin(options.twin_from_m, map.landmarks);
    Pose T_world_submap = T_odom_submap;
    T_world_submap.translation_m.x() -= kFar_m;
    for (MixtureLandmark& landmark : map.landmarks) {
      landmark.position.mean_m = options.T_earlier_submap * (T_world_submap.inverse() * landmark.position.mean_m);
    }
    map.stddev_xy_m = options.stddev_xy_m;
    if (options.is_reversed) std::reverse(map.landmarks.begin(), map.landmarks.end());
    return map;
  };
  Rng rng(seed);
  Rng tree_rng(1);
  for (std::size_t f = 0; f < 2 * kFrames; ++f) {
    const bool is_second = f >= kFrames;
    const double x_m = static_cast<double>(f % kFrames);
    const Pose T_odom_base{Eigen::Quaterniond::Identity(), {x_m + (is_second ? kFar_m : 0.0), 0.0, 0.0}};
    const Detections seen = detect(is_second ? second_street : first_street, x_m, options, rng, passes.truth[f]);
    if (f == kFrames) {
      passes.first.push_back(mapper.finish());
      driveThroughNothing(mapper, tree_rng);
    }
    auto finished = feed(mapper, {f, static_cast<Stamp>(f), T_odom_base, seen}, tree_rng, earlier_map);
    if (finished) (is_second ? passes.second : passes.first).push_back(std::move(*finished));
    if (!is_second) continue;
    const std::size_t alignments = distinctAlignments(mapper.hypotheses());
    passes.most_alignments = std::max(passes.most_alignments, alignments);
    if (alignments > 1) passes.both_alive_m.push_back(x_m);
  }
  passes.second.push_back(mapper.finish());
  return passes;
}

/// Landmark of each true object in a pass, ids resolved: the one that most of its detections went to.
std::map<int, LandmarkId> landmarkOfObject(const Passes& passes, const std::vector<FinishedSubmap>& submaps) {
  Identity identity;
  ClosureId closure(0);
  for (const auto* list : {&passes.first, &passes.second}) {
    for (const auto& [submap, frames, alignment, unsure] : *list) {
      identity.add(submap);
      if (!alignment) continue;
      identity.add(closure, alignment->pairs);
      identity.decide({{closure, true}});
      ++closure;
    }
  }
  std::map<int, std::map<LandmarkId, int>> votes;
  for (const auto& [submap, frames, alignment, unsure] : submaps) {
    for (const DetectionAssociation& association : submap.associations) {
      const int truth = passes.truth.at(association.frame).at(static_cast<std::size_t>(association.row));
      ++votes[truth][identity.landmarkOf(association.landmark)];
    }
  }
  std::map<int, LandmarkId> result;
  for (const auto& [object, ids] : votes) {
    const auto most =
        std::max_element(ids.begin(), ids.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
    result[object] = most->first;
  }
  return result;
}

Pose shifted(double x_m, double y_m, double yaw_rad) {
  return {expRotation({0.0, 0.0, yaw_rad}), {x_m, y_m, 0.0}};
}

class MapBranchingSeeds : public testing::TestWithParam<std::uint64_t> {};

TEST_P(MapBranchingSeeds, TheTrueOffsetIsFoundAndLandmarksHaveTheIdsOfTheEarlierPass) {
  Options options;
  options.T_earlier_submap = shifted(2.4, -1.8, 0.035);
  const Passes passes = drive(GetParam(), options);
  ASSERT_EQ(passes.second.size(), 2U);
  for (const auto& [submap, frames, alignment, unsure] : passes.second) {
    ASSERT_TRUE(alignment.has_value());
    EXPECT_TRUE(alignment->is_accepted);
    const Pose error = options.T_earlier_submap.inverse() * alignment->T_earlier_submap;
    EXPECT_LT(error.translation_m.head<2>().norm(), 0.2);
    EXPECT_LT(angularDistance(error.rotation, Eigen::Quaterniond::Identity()), 0.01);
  }
  const auto first = landmarkOfObject(passes, passes.first);
  const auto second = landmarkOfObject(passes, passes.second);
  int common = 0;
  int same = 0;
  for (const auto& [object, id] : second) {
    const auto found = first.find(object);
    if (found == first.end()) continue;
    ++common;
    same += found->second == id;
  }
  EXPECT_GE(common, 30);
  EXPECT_GE(same, 0.93 * common) << same << " of " << common;
}

TEST_P(MapBranchingSeeds, APlaceThatWasNotVisitedStaysNew) {
  Options options;
  options.is_same_street = false;
  const Passes passes = drive(GetParam(), options);
  for (const auto& [submap, frames, alignment, unsure] : passes.second) {
    EXPECT_FALSE(alignment && alignment->is_accepted);
    for (const MixtureLandmark& landmark : submap.landmarks) {
      EXPECT_GE(landmark.first_submap.index() + 1, submap.id.index());
    }
  }
}

TEST_P(MapBranchingSeeds, TwoEqualStreetsStayTwoHypothesesUntilTheyDiffer) {
  Options options;
  options.twin_from_m = 44.0;  // in sight from 16 m on
  options.stddev_xy_m = 4.0;
  const Passes passes = drive(GetParam(), options);
  EXPECT_EQ(passes.most_alignments, 2U);
  EXPECT_GE(passes.both_alive_m.size(), 8U);
  ASSERT_TRUE(passes.second.back().alignment.has_value());
  EXPECT_TRUE(passes.second.back().alignment->is_accepted);
  EXPECT_NEAR(passes.second.back().alignment->T_earlier_submap.translation_m.y(), 3.0, 0.3);
}

TEST_P(MapBranchingSeeds, OrderOfDetectionsAndEarlierLandmarksDoesNotMatter) {
  Options options;
  options.T_earlier_submap = shifted(2.4, -1.8, 0.035);
  const Passes a = drive(GetParam(), options);
  options.is_reversed = true;
  const Passes b = drive(GetParam(), options);
  ASSERT_EQ(a.second.size(), b.second.size());
  for (std::size_t i = 0; i < a.second.size(); ++i) {
    ASSERT_EQ(a.second[i].alignment.has_value(), b.second[i].alignment.has_value());
    if (!a.second[i].alignment) continue;
    const MapAlignment& first = *a.second[i].alignment;
    const MapAlignment& second = *b.second[i].alignment;
    EXPECT_EQ(first.is_accepted, second.is_accepted);
    EXPECT_EQ(first.matches, second.matches);
    EXPECT_LT((first.T_earlier_submap.translation_m - second.T_earlier_submap.translation_m).norm(), 1e-6);
  }
}

INSTANTIATE_TEST_SUITE_P(Worlds, MapBranchingSeeds, testing::Range<std::uint64_t>(1, 7));

TEST(MapBranchingTest, SwitchedOffTheEarlierMapIsNotAskedFor) {
  MapperConfig config;
  config.alignment.enabled = false;
  for (const FinishedSubmap& finished : drive(1, {}, config).second) EXPECT_FALSE(finished.alignment.has_value());
}

}  // namespace
}  // namespace semantic_mht_slam
