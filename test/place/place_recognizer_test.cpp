#include "semantic_mht_slam/place/place_recognizer.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include "scene_test_util.h"

namespace semantic_mht_slam {
namespace {

const ClassTable kClasses = makeStreetClasses();
constexpr double kSpacing_m = 10.0;
constexpr int kPerSubmap = 3;

/// Objects of a world along the x axis.
Scene makeWorld(double length_m, Rng& rng) {
  Scene world;
  for (int i = 0; i < static_cast<int>(length_m * 0.4); ++i) {
    SceneObject object;
    object.position_m = {rng.uniform(0.0, length_m), rng.uniform(-15.0, 15.0), rng.uniform(-0.3, 0.3)};
    object.cov_m2 = Eigen::Matrix3d::Identity() * 0.0025;
    object.class_index = static_cast<ClassIndex>(rng.index(3));
    object.landmark = static_cast<LandmarkId>(i + 1);
    world.objects.push_back(object);
  }
  return world;
}

Scene around(const Scene& world, const Pose& T_world_keyframe, Rng& rng) {
  Scene near;
  for (const SceneObject& object : world.objects) {
    if ((object.position_m - T_world_keyframe.translation_m).head<2>().norm() < 35.0) near.objects.push_back(object);
  }
  return seenFrom(near, T_world_keyframe, rng);
}

/// A drive in the making: keyframes and their estimates are handed over submap by submap.
class Drive {
 public:
  explicit Drive(const PlaceConfig& config) : recognizer_(config, kClasses) {}

  /// A keyframe at `T_map_keyframe`; records of a submap that is thereby finished are kept.
  void pass(const Pose& T_map_keyframe, Scene scene) {
    driven_m_ += kSpacing_m;
    Keyframe keyframe;
    keyframe.frame = T_map_keyframe_.size();
    keyframe.submap = SubmapId(static_cast<int>(T_map_keyframe_.size()) / kPerSubmap);
    keyframe.driven_m = driven_m_;
    keyframe.scene = std::move(scene);
    pending_.push_back(std::move(keyframe));
    T_map_keyframe_.push_back(T_map_keyframe);
    if (static_cast<int>(pending_.size()) == kPerSubmap) finish();
  }

  void finish() {
    const std::vector<PlaceMatch> found = recognizer_.process(std::move(pending_), T_map_keyframe_);
    pending_.clear();
    records_.insert(records_.end(), found.begin(), found.end());
  }

  int accepted() const {
    return static_cast<int>(
        std::count_if(records_.begin(), records_.end(), [](const PlaceMatch& m) { return m.accepted; }));
  }
  const std::vector<PlaceMatch>& records() const { return records_; }
  const std::vector<Pose>& estimates() const { return T_map_keyframe_; }
  PlaceRecognizer& recognizer() { return recognizer_; }

 private:
  PlaceRecognizer recognizer_;
  double driven_m_ = 0.0;
  std::vector<Keyframe> pending_;
  std::vector<Pose> T_map_keyframe_;
  std::vector<PlaceMatch> records_;
};

/// Along the street and, on another lane, back.
void driveThereAndBack(const Scene& world, int keyframes, Drive& drive, Rng& rng) {
  for (int i = 0; i < keyframes; ++i) {
    const Pose T_map_keyframe = planarPose(40.0 + kSpacing_m * i, 0.0, 0.0);
    drive.pass(T_map_keyframe, around(world, T_map_keyframe, rng));
  }
  for (int i = keyframes - 1; i >= 0; --i) {
    const Pose T_map_keyframe = planarPose(43.0 + kSpacing_m * i, 3.0, M_PI);
    drive.pass(T_map_keyframe, around(world, T_map_keyframe, rng));
  }
}

TEST(PlaceRecognizerTest, FindsTheWayBackAndNothingWrong) {
  for (int seed = 0; seed < 5; ++seed) {
    Rng rng(seed);
    const Scene world = makeWorld(400.0, rng);
    Drive drive({});
    driveThereAndBack(world, 30, drive, rng);
    EXPECT_GE(drive.accepted(), 15) << "seed " << seed;
    for (const PlaceMatch& match : drive.records()) {
      EXPECT_EQ(match.accepted, match.refusal == PlaceRefusal::kNone);
      EXPECT_EQ(match.accepted, reasonText(match.refusal).empty());
      if (!match.accepted) continue;
      const Pose truth = drive.estimates()[match.match].inverse() * drive.estimates()[match.query];
      EXPECT_LT((truth.translation_m - match.T_match_query.translation_m).norm(), 0.5) << "seed " << seed;
      for (const auto& pair : match.pairs) EXPECT_NE(pair.first, kNoLandmark);
      const auto right = std::count_if(match.pairs.begin(), match.pairs.end(),
                                       [](const auto& pair) { return pair.first == pair.second; });
      EXPECT_GT(static_cast<double>(right), 0.9 * static_cast<double>(match.pairs.size()));
    }
  }
}

TEST(PlaceRecognizerTest, AcceptsNothingWhereNoPlaceIsRevisited) {
  for (int seed = 0; seed < 5; ++seed) {
    Rng rng(50 + seed);
    Drive drive({});
    driveThereAndBack(makeWorld(400.0, rng), 30, drive, rng);
    Drive elsewhere({});
    const Scene there = makeWorld(400.0, rng);
    const Scene back = makeWorld(400.0, rng);
    for (int i = 0; i < 60; ++i) {
      const Pose T_map_keyframe = planarPose(40.0 + kSpacing_m * (i % 30), 0.0, 0.0);
      elsewhere.pass(T_map_keyframe, around(i < 30 ? there : back, T_map_keyframe, rng));
    }
    EXPECT_EQ(elsewhere.accepted(), 0) << "seed " << seed;
    EXPECT_FALSE(elsewhere.records().empty());
  }
}

TEST(PlaceRecognizerTest, RefusesEmptyScenesSingleClassesAndRows) {
  Rng rng(3);
  Scene single = makeWorld(400.0, rng);
  for (SceneObject& object : single.objects) object.class_index = 2;
  Scene row = makeWorld(400.0, rng);
  for (SceneObject& object : row.objects) object.position_m.y() = 5.0;
  for (const Scene& world : {Scene{}, single, row}) {
    Drive drive({});
    driveThereAndBack(world, 15, drive, rng);
    EXPECT_EQ(drive.accepted(), 0);
  }
}

TEST(PlaceRecognizerTest, RefusesAPlaceThatStandsTwiceInTheMap) {
  Rng rng(4);
  const Scene world = makeWorld(120.0, rng);
  PlaceConfig config;
  config.drift_gate = false;
  config.far_factor = 0.0;
  for (const bool is_twin : {false, true}) {
    Drive drive(config);
    for (int i = 0; i < 6; ++i) {
      const Pose T_street_keyframe = planarPose(40.0 + kSpacing_m * i, 0.0, 0.0);
      drive.pass(T_street_keyframe, around(world, T_street_keyframe, rng));
    }
    for (int i = 0; i < 30; ++i) drive.pass(planarPose(1000.0, kSpacing_m * i, 0.0), {});
    if (is_twin) {  // the same objects 5000 m to the side, further than drift explains
      for (int i = 0; i < 6; ++i) {
        const Pose T_street_keyframe = planarPose(40.0 + kSpacing_m * i, 0.0, 0.0);
        Pose T_map_keyframe = T_street_keyframe;
        T_map_keyframe.translation_m.y() = 5000.0;
        drive.pass(T_map_keyframe, around(world, T_street_keyframe, rng));
      }
      for (int i = 0; i < 30; ++i) drive.pass(planarPose(2000.0, kSpacing_m * i, 0.0), {});
    }
    const Pose T_street_keyframe = planarPose(62.0, 1.0, 0.5);
    const std::vector<std::size_t> alike = drive.recognizer().mostAlike(around(world, T_street_keyframe, rng));
    ASSERT_GE(alike.size(), 2U);
    EXPECT_EQ(alike.size(), static_cast<std::size_t>(config.max_candidates));
    const auto has = [&](std::size_t place) { return std::find(alike.begin(), alike.end(), place) != alike.end(); };
    EXPECT_TRUE(has(2));
    EXPECT_EQ(has(2 + 36), is_twin);
  }
}

TEST(PlaceRecognizerTest, APoseFurtherThanDriftExplainsIsNotACandidate) {
  Rng rng(5);
  const Scene world = makeWorld(400.0, rng);
  Drive drive({});
  for (int i = 0; i < 30; ++i) {
    const Pose T_world_keyframe = planarPose(40.0 + kSpacing_m * (i % 15), 0.0, 0.0);
    const Pose T_map_keyframe = planarPose(40.0 + kSpacing_m * (i % 15), i < 15 ? 0.0 : 100.0, 0.0);
    drive.pass(T_map_keyframe, around(world, T_world_keyframe, rng));
  }
  EXPECT_EQ(drive.accepted(), 0);
}

TEST(PlaceRecognizerTest, SameInputGivesSameRecords) {
  std::vector<PlaceMatch> first;
  for (int run = 0; run < 2; ++run) {
    Rng rng(6);
    Drive drive({});
    driveThereAndBack(makeWorld(250.0, rng), 15, drive, rng);
    if (run == 0) first = drive.records();
    ASSERT_EQ(drive.records().size(), first.size());
    for (std::size_t i = 0; i < first.size(); ++i) {
      EXPECT_EQ(drive.records()[i].match, first[i].match);
      EXPECT_EQ(drive.records()[i].verification_score, first[i].verification_score);
      EXPECT_EQ(drive.records()[i].cov, first[i].cov);
    }
  }
}

TEST(PlaceRecognizerTest, WrongInputIsRefused) {
  PlaceRecognizer recognizer({}, kClasses);
  EXPECT_THROW(recognizer.process({Keyframe{}}, {}), std::invalid_argument);
  Keyframe first;
  first.driven_m = 10.0;
  recognizer.process({first}, {Pose::identity()});
  EXPECT_THROW(recognizer.process({Keyframe{}}, {Pose::identity(), Pose::identity()}), std::invalid_argument);
}

}  // namespace
}  // namespace semantic_mht_slam
