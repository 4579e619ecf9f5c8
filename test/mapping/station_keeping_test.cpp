#include "semantic_mht_slam/mapping/station_keeping.h"

#include <gtest/gtest.h>

namespace semantic_mht_slam {
namespace {

constexpr double kSpacing_m = 5.0;

Detection as(const Detection& detection) {
  Detection result = detection;
  result.cov_m2 = Eigen::Matrix3d::Identity();
  return result;
}

/// Frames that see `count` objects 10 m ahead, one beside the other, with ids from 1.
struct Drive {
  void add(const Pose& T_submap_base, const Motion& motion, int count) {
    Detections detections(static_cast<std::size_t>(count));
    FusedAssociations fused;
    for (int i = 0; i < count; ++i) {
      detections[static_cast<std::size_t>(i)].position_m = {10.0, 1.0 * i, 0.0};
      fused.landmark_of_measurement.push_back(static_cast<LandmarkId>(i + 1));
    }
    stations.add(associations.size(), T_submap_base, motion, detections, kSpacing_m);
    associations.push_back(fused);
  }

  void addStraight(double x_m, int count) { add({Eigen::Quaterniond::Identity(), {x_m, 0.0, 0.0}}, {x_m, 0.0}, count); }

  StationKeeping stations;
  std::vector<FusedAssociations> associations;
};

TEST(StationKeepingTest, StationsAreAsFarApartAsWanted) {
  Drive drive;
  for (int i = 0; i <= 20; ++i) drive.addStraight(i, 10);
  const auto stretches = drive.stations.stretches(drive.associations, as);
  ASSERT_EQ(stretches.size(), 1U);
  ASSERT_EQ(stretches[0].motion.size(), 4U);
  for (const Motion& motion : stretches[0].motion) EXPECT_DOUBLE_EQ(motion.way_m, kSpacing_m);
  EXPECT_EQ(stretches[0].observations.size(), 50U);
}

TEST(StationKeepingTest, TurningOnTheSpotMakesStations) {
  Drive drive;
  for (int i = 0; i <= 20; ++i)
    drive.add({expRotation({0.0, 0.0, 0.11 * i}), Eigen::Vector3d::Zero()}, {0.0, 0.11 * i}, 10);
  EXPECT_EQ(drive.stations.stretches(drive.associations, as)[0].motion.size(), 5U);
}

TEST(StationKeepingTest, FramesThatShowLittleAreTakenTogether) {
  Drive drive;
  for (int i = 0; i <= 10; ++i) drive.addStraight(0.5 * i, 1);
  const OdometryStretch stretch = drive.stations.stretches(drive.associations, as)[0];
  ASSERT_EQ(stretch.observations.size(), 4U) << "those within a metre of the first station, and that of the second";
  EXPECT_DOUBLE_EQ(stretch.observations[1].position_m.x(), 10.5) << "carried to the station";
  EXPECT_EQ(stretch.observations[3].keyframe, 1);
}

TEST(StationKeepingTest, DetectionsThatSayNothingAreLeftOut) {
  Drive drive;
  for (int i = 0; i <= 20; ++i) drive.addStraight(i, 10);
  const auto far_right = [](const Detection& detection) {
    return detection.position_m.y() > 6.5 ? std::optional<Detection>(as(detection)) : std::nullopt;
  };
  EXPECT_EQ(drive.stations.stretches(drive.associations, far_right)[0].observations.size(), 15U);
}

TEST(StationKeepingTest, ALongSubmapComesInPieces) {
  Drive drive;
  for (int i = 0; i <= 30; ++i) drive.addStraight(kSpacing_m * i, 10);
  std::size_t steps = 0;
  for (const OdometryStretch& stretch : drive.stations.stretches(drive.associations, as)) {
    EXPECT_LE(stretch.motion.size(), 12U);
    steps += stretch.motion.size();
  }
  EXPECT_EQ(steps, 30U);
}

TEST(StationKeepingTest, FalsePositivesAreNotTaken) {
  Drive drive;
  drive.addStraight(0.0, 10);
  drive.addStraight(5.0, 10);
  drive.associations[0].landmark_of_measurement[3] = kNoLandmark;
  EXPECT_EQ(drive.stations.stretches(drive.associations, as)[0].observations.size(), 19U);
}

}  // namespace
}  // namespace semantic_mht_slam
