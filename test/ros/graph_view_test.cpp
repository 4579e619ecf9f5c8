#include "semantic_mht_slam/ros/graph_view.h"

#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "semantic_mht_slam/slam/slam.h"

#include "support/recordings.h"

namespace semantic_mht_slam {
namespace {

constexpr double kRadius_m = 20.0;

/// Drives rounds on a circle along which poles stand, by exact odometry.
std::unique_ptr<Slam> driveRounds(double rounds) {
  auto driven = std::make_unique<Slam>(SlamConfig{}, makeTwoClasses());
  Slam& slam = *driven;
  Rng rng(5);
  std::vector<Eigen::Vector3d> poles;
  for (int i = 0; i < 40; ++i) {
    const double angle = 2.0 * M_PI * rng.uniform(0.0, 1.0);
    const double radius_m = kRadius_m + (i % 2 == 0 ? 6.0 : -6.0) + rng.uniform(-1.0, 1.0);
    poles.emplace_back(radius_m * std::cos(angle), radius_m * std::sin(angle), 0.0);
  }
  const int frames = static_cast<int>(rounds * 2.0 * M_PI * kRadius_m);
  for (int i = 0; i < frames; ++i) {
    const double angle = static_cast<double>(i) / kRadius_m;
    const Pose T_odom_base{expRotation({0.0, 0.0, angle + 0.5 * M_PI}),
                           {kRadius_m * std::cos(angle), kRadius_m * std::sin(angle), 0.0}};
    Detections detections;
    for (const Eigen::Vector3d& pole : poles) {
      const Eigen::Vector3d position_m = T_odom_base.inverse() * pole;
      if (position_m.norm() > 15.0) continue;
      detections.emplace_back();
      detections.back().position_m = position_m;
      detections.back().row = static_cast<int>(detections.size()) - 1;
    }
    const Stamp stamp = (i + 1) * 100000000LL;
    slam.addOdometry({stamp, T_odom_base});
    slam.addDetections(stamp, detections);
  }
  slam.finish();
  return driven;
}

const visualization_msgs::Marker& find(const visualization_msgs::MarkerArray& array, const std::string& name) {
  for (const visualization_msgs::Marker& marker : array.markers) {
    if (marker.ns == name) return marker;
  }
  throw std::out_of_range(name);
}

TEST(GraphViewTest, EverySubmapHasAnOutlineAroundItsKeyframes) {
  const auto driven = driveRounds(1.0);
  const Slam& slam = *driven;
  const std::size_t submaps = slam.map().submaps().size();
  ASSERT_GE(submaps, 2U);
  const visualization_msgs::MarkerArray array = toSubmapMarkers(slam.map(), 1.0, "map");
  const visualization_msgs::Marker& outlines = find(array, "submaps");
  EXPECT_EQ(outlines.points.size(), 8 * submaps);
  EXPECT_EQ(outlines.colors.size(), outlines.points.size());
  EXPECT_EQ(outlines.action, visualization_msgs::Marker::ADD);
}

TEST(GraphViewTest, ClosuresAreLinesAndMessagesOfTheirOwnKind) {
  const auto driven = driveRounds(2.5);
  const Slam& slam = *driven;
  const std::size_t all = slam.map().closures().size();
  const std::size_t accepted = acceptedClosures(slam.map());
  ASSERT_GT(accepted, 0U) << "the same circle again";
  ClosureNews news;
  LiveConfig live;
  live.refused_closures = true;
  EXPECT_EQ(find(toLoopMarkers(slam.map(), 1.0, live, "map"), "accepted").points.size(), 2 * accepted);
  EXPECT_EQ(find(toLoopMarkers(slam.map(), 1.0, live, "map"), "places").points.size(), accepted);
  EXPECT_EQ(find(toLoopMarkers(slam.map(), 1.0, live, "map"), "refused").points.size(), 2 * (all - accepted));
  EXPECT_TRUE(find(toLoopMarkers(slam.map(), 1.0, {}, "map"), "refused").points.empty());
  const std::vector<LoopClosure> messages = toLoopClosures(slam.map(), news.takeNews(slam.map()), "map");
  for (std::size_t i = 0; i < messages.size(); ++i) {
    const LoopClosureRecord& record = slam.map().closures()[ClosureId(i)];
    const FixedAxesCov expected = inFixedAxes(record.T_match_query, record.cov);
    EXPECT_EQ(messages[i].transform.covariance[1], expected(0, 1)) << "row-major, axes of the match frame";
    EXPECT_EQ(messages[i].transform.covariance[6 * 1 + 5], expected(1, 5));
    EXPECT_EQ(messages[i].transform.covariance[35], expected(5, 5));
  }
  ASSERT_EQ(messages.size(), all);
  EXPECT_TRUE(news.takeNews(slam.map()).empty()) << "told already";
  for (const LoopClosure& message : messages) {
    EXPECT_LT(message.match_stamp, message.header.stamp);
    EXPECT_LT(message.match_submap, message.query_submap);
    EXPECT_EQ(message.accepted, message.reason.empty());
  }
}

TEST(GraphViewTest, WhatIsNotThereIsDeletedFromTheDisplay) {
  const Slam slam(SlamConfig{}, makeTwoClasses());
  for (const auto& array : {toLoopMarkers(slam.map(), 1.0, {}, "map"), toSubmapMarkers(slam.map(), 1.0, "map"),
                            toOdometryMarkers({}, 1.0, "map")}) {
    for (const visualization_msgs::Marker& marker : array.markers) {
      EXPECT_EQ(marker.action, visualization_msgs::Marker::DELETE) << marker.ns;
    }
  }
}

}  // namespace
}  // namespace semantic_mht_slam
