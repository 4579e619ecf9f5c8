#include "semantic_mht_slam/slam/map_graph.h"

#include <memory>

#include <gtest/gtest.h>

#include "semantic_mht_slam/slam/map_uncertainty.h"

#include "support/expect_input_error.h"
#include "support/square_drive.h"

namespace semantic_mht_slam {
namespace {

class MapGraphTest : public testing::Test {
 protected:
  /// A submap of one keyframe that sees a landmark 1 m ahead.
  GraphUpdate add(double x_m, LandmarkId landmark, double seen_m = 1.0) {
    auto submap = std::make_shared<Submap>();
    submap->id = map_.submaps().nextId();
    Keyframe keyframe;
    keyframe.driven_m = x_m;
    keyframe.T_odom_base.translation_m.x() = x_m;
    const auto keyframes = map_.add(std::move(submap), {keyframe});
    graph_.add(map_, keyframes, {{{landmark, 0, {seen_m, 0.0, 0.0}, 1e-3 * Eigen::Matrix3d::Identity(), 1}}},
               OdometryModel{});
    return optimize();
  }

  GraphUpdate optimize() {
    map_.apply(graph_.review(map_));
    const GraphUpdate update = graph_.optimize(map_.takeChanges());
    map_.apply(update);
    return update;
  }

  ClosureId close(std::size_t query, std::size_t match, const Pose& T_match_query,
                  const std::vector<SameLandmark>& pairs) {
    LoopClosureRecord closure;
    closure.query_keyframe = KeyframeId(query);
    closure.match_keyframe = KeyframeId(match);
    closure.is_verified = true;
    closure.T_match_query = T_match_query;
    closure.cov = 1e-4 * PoseCov::Identity();
    closure.pairs = pairs;
    return map_.add(closure);
  }

  Map map_{0.5};
  MapGraph graph_{BackEndConfig{}, makeStreetClasses()};
};

TEST_F(MapGraphTest, ASolutionThatFailsIsCountedAndSaid) {
  EXPECT_EQ(add(0.0, 1).failure, "");
  EXPECT_EQ(graph_.status().failures, 0U);
  EXPECT_NE(add(1.0, 1, 1e200).failure, "");
  EXPECT_EQ(graph_.status().failures, 1U);
  EXPECT_FALSE(graph_.status().newest_failure.empty());
}

TEST_F(MapGraphTest, OdometryThatTheMapTellsIsMadeAgainAndOtherIsKept) {
  add(0.0, 1);
  add(1.0, 1);
  graph_.goOnAt({Eigen::Quaterniond::Identity(), {0.0, 5.0, 0.0}});
  add(2.0, 2);
  StateArchive writing;
  graph_.transfer(writing, map_);
  const std::string bytes = writing.written();
  MapGraph again{BackEndConfig{}, makeStreetClasses()};
  StateArchive reading(bytes);
  again.transfer(reading, map_);
  reading.requireEnd();
  for (const KeyframeId id : map_.keyframes().ids()) {
    EXPECT_EQ(again.node(id).T_previous_node.matrix(), graph_.node(id).T_previous_node.matrix());
    EXPECT_EQ(again.node(id).odometry_cov, graph_.node(id).odometry_cov);
    EXPECT_EQ(again.node(id).shared_errors, graph_.node(id).shared_errors);
  }
  StateArchive writing_again;
  again.transfer(writing_again, map_);
  EXPECT_EQ(writing_again.written(), bytes);
  const Map other{0.5};
  StateArchive refused(bytes);
  MapGraph none{BackEndConfig{}, makeStreetClasses()};
  expectInputError([&] { none.transfer(refused, other); }, {"a submap that there is not"});
}

TEST_F(MapGraphTest, AClosureThatOdometryContradictsJoinsNothingAndOneThatFitsJoinsItsPairs) {
  for (std::size_t i = 0; i < 8; ++i) add(10.0 * static_cast<double>(i), 1 + i);
  const Pose far{Eigen::Quaterniond::Identity(), {30.0, 0.0, 0.0}};
  const ClosureId wrong = close(7, 0, far, {{8, 1}});  // by odometry they are 70 m apart
  const ClosureId right = close(7, 3, {Eigen::Quaterniond::Identity(), {40.0, 0.0, 0.0}}, {{8, 4}});
  optimize();
  EXPECT_FALSE(map_.closures()[wrong].is_accepted);
  EXPECT_TRUE(map_.closures()[right].is_accepted) << map_.closures()[right].reason;
  EXPECT_NE(*graph_.landmark(8), *graph_.landmark(1));
  EXPECT_EQ(*graph_.landmark(8), *graph_.landmark(4));
  EXPECT_EQ(map_.identity().landmarkOf(8), 4U);
}

TEST_F(MapGraphTest, WhatIsNotKnownOfTheScaleGrowsWithTheDistanceFromTheFirstPose) {
  for (std::size_t i = 0; i < 8; ++i) add(10.0 * static_cast<double>(i), 1 + i);
  const MapUncertainty exact = uncertaintyOf(map_, graph_, {gaugeCov(), 0.0});
  const MapUncertainty scaled = uncertaintyOf(map_, graph_, {gaugeCov(), 0.01});
  const MapUncertainty coarse = coarseUncertaintyOf(map_, graph_, {gaugeCov(), 0.01});
  ASSERT_EQ(scaled.keyframes.size(), 8U);
  const KeyframeId last(7);
  EXPECT_NEAR(scaled.keyframes[last](0, 0) - exact.keyframes[last](0, 0), 0.7 * 0.7, 1e-3);
  EXPECT_NEAR(scaled.keyframes[last](1, 1) - exact.keyframes[last](1, 1), 0.0, 1e-6);
  EXPECT_NEAR(coarse.keyframes[last](0, 0), scaled.keyframes[last](0, 0), 0.1 * scaled.keyframes[last](0, 0));
  EXPECT_NEAR(newestKeyframe(map_, graph_, {gaugeCov(), 0.01}).total()(0, 0), coarse.keyframes[last](0, 0), 0.05);
  EXPECT_NEAR(scaled.landmarks.at(8)(0, 0) - exact.landmarks.at(8)(0, 0), 0.71 * 0.71, 1e-3);
  EXPECT_LT(exact.keyframes[KeyframeId(0)].trace(), 1e-5) << "the map begins here";
}

TEST_F(MapGraphTest, AFirstKeyframeThatIsNotExactMakesEverythingAsInexact) {
  for (std::size_t i = 0; i < 3; ++i) add(10.0 * static_cast<double>(i), 1 + i);
  FixedAxesCov start = 0.04 * FixedAxesCov::Identity();
  start.bottomRightCorner<3, 3>() = 1e-4 * Eigen::Matrix3d::Identity();
  const MapUncertainty exact = uncertaintyOf(map_, graph_, {gaugeCov(), 0.0});
  const MapUncertainty moved = uncertaintyOf(map_, graph_, {start, 0.0});
  const KeyframeId last(2);
  EXPECT_NEAR(moved.keyframes[last](0, 0) - exact.keyframes[last](0, 0), 0.04, 1e-4);
  EXPECT_NEAR(moved.keyframes[last](1, 1) - exact.keyframes[last](1, 1), 0.04 + 1e-4 * 400.0, 1e-3) << "swung";
  EXPECT_NEAR(moved.landmarks.at(3)(1, 1) - exact.landmarks.at(3)(1, 1), 0.04 + 1e-4 * 441.0, 1e-3);
}

}  // namespace
}  // namespace semantic_mht_slam
