#include "semantic_mht_slam/simulation/vehicle_motion.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace semantic_mht_slam {
namespace {

constexpr double kPi = 3.14159265358979323846;

struct Drive {
  StreetNetwork network;
  VehiclePath path;
  VehicleMotion motion;
};

Drive makeDrive(const RouteConfig& config, std::uint64_t seed) {
  Drive drive;
  drive.network = buildStreetNetwork({}, Rng(seed));
  const std::vector<Leg> legs = planRoute(drive.network, config, 1.2 * config.length_m, Rng(seed));
  drive.path = smoothPath(drive.network, legs, config, Rng(seed));
  drive.motion = drivePath(drive.path, drive.network.terrain, config, Rng(seed));
  return drive;
}

double yawOf(const Pose& pose) {
  const Eigen::Vector3d forward = pose.rotation * Eigen::Vector3d::UnitX();
  return std::atan2(forward.y(), forward.x());
}

TEST(VehiclePathTest, TurnsWithTheConfiguredRadius) {
  StreetNetworkConfig square;
  square.irregularity = 0.0;
  square.bend_m = 0.0;
  square.removed_street_prob = 0.0;
  const StreetNetwork network = buildStreetNetwork(square, Rng(1));
  RouteConfig config;
  config.lateral_wander_stddev_m = 0.0;
  config.lane_offset_m = 0.0;
  const VehiclePath path = smoothPath(network, planRoute(network, config, 2000.0, Rng(1)), config, Rng(1));
  double sharpest = 0.0;
  for (int step = 10; 0.5 * step < path.length() - 5.0; ++step) {
    const double s = 0.5 * step;
    const Eigen::Vector2d a = path.at(s - 1.0).direction;
    const Eigen::Vector2d b = path.at(s + 1.0).direction;
    sharpest = std::max(sharpest, std::abs(std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b))) / 2.0);
  }
  EXPECT_NEAR(1.0 / sharpest, config.corner_radius_m, 0.1 * config.corner_radius_m);
}

TEST(VehiclePathTest, KeepsToTheRightOfTheCentreLine) {
  RouteConfig config;
  config.lateral_wander_stddev_m = 0.0;
  const StreetNetwork network = buildStreetNetwork({}, Rng(1));
  const Leg leg = {0, true};
  const VehiclePath path = smoothPath(network, {leg}, config, Rng(1));
  const Street& street = network.streets[0];
  const StreetPoint middle = pointOnStreet(street, 0.5 * street.length_m);
  double nearest = 1e9;
  for (const Eigen::Vector2d& point : path.points_m) {
    nearest = std::min(nearest, (point - (middle.position_m + config.lane_offset_m * leftOf(middle.direction))).norm());
  }
  EXPECT_LT(nearest, 0.6);  // driven backwards, the right side is the left of the street
}

TEST(VehicleMotionTest, FrameSpacingAndTurnsStayWithinTheLimits) {
  const RouteConfig config;
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const VehicleMotion motion = makeDrive(config, seed).motion;
    int moving = 0;
    for (std::size_t k = 1; k < motion.T_world_base.size(); ++k) {
      EXPECT_EQ(motion.stamps[k] - motion.stamps[k - 1], 100000000);
      const Pose step = motion.T_world_base[k - 1].inverse() * motion.T_world_base[k];
      const double planar = motion.along_m[k] - motion.along_m[k - 1];
      EXPECT_GE(planar, 0.0);
      EXPECT_LE(planar, config.cruise_speed_mps / config.frame_rate_hz + 1e-9);
      EXPECT_NEAR(step.translation_m.norm(), planar, 0.01 + 0.05 * planar);
      EXPECT_LT(std::abs(yawOf(step)), 0.12);
      moving += planar > 0.3;
    }
    EXPECT_GT(moving, 0.8 * static_cast<double>(motion.stamps.size())) << "seed " << seed;
    EXPECT_NEAR(motion.along_m.back(), config.length_m, 1.0);
  }
}

TEST(VehicleMotionTest, SlowsInCurvesAndAcceleratesWithinTheLimit) {
  const RouteConfig config;
  const VehicleMotion motion = makeDrive(config, 1).motion;
  for (std::size_t k = 2; k < motion.along_m.size(); ++k) {
    const double speed = (motion.along_m[k] - motion.along_m[k - 1]) * config.frame_rate_hz;
    const double before = (motion.along_m[k - 1] - motion.along_m[k - 2]) * config.frame_rate_hz;
    const double turn = yawOf(motion.T_world_base[k - 1].inverse() * motion.T_world_base[k]);
    EXPECT_LT(speed * std::abs(turn) * config.frame_rate_hz, 1.4 * config.lateral_acceleration_mps2);
    // a stop is entered and left at a creeping 0.5 m/s
    EXPECT_LT(std::abs(speed - before), 2.0 * config.acceleration_mps2 / config.frame_rate_hz + 0.5);
  }
}

TEST(VehicleMotionTest, StopsOnlyWhereStopsAreWanted) {
  RouteConfig config;
  const auto standing = [&](double prob) {
    config.stop_prob = prob;
    const VehicleMotion motion = makeDrive(config, 1).motion;
    int count = 0;
    for (std::size_t k = 1; k < motion.along_m.size(); ++k) count += motion.along_m[k] == motion.along_m[k - 1];
    return count;
  };
  EXPECT_EQ(standing(0.0), 0);
  EXPECT_GT(standing(1.0), 50);
}

TEST(VehicleMotionTest, RidesAboveTheGroundAndTiltsWithIt) {
  RouteConfig config;
  config.tilt_stddev_rad = 0.0;
  const Drive drive = makeDrive(config, 2);
  for (const Pose& pose : drive.motion.T_world_base) {
    const Eigen::Vector2d place = pose.translation_m.head<2>();
    EXPECT_NEAR(pose.translation_m.z(), drive.network.terrain.height(place) + config.sensor_height_m, 1e-9);
    const Eigen::Vector2d slope = drive.network.terrain.gradient(place);
    const Eigen::Vector3d normal = Eigen::Vector3d(-slope.x(), -slope.y(), 1.0).normalized();
    EXPECT_LT(std::acos(std::min(1.0, normal.dot(pose.rotation * Eigen::Vector3d::UnitZ()))), 0.2 * kPi / 180.0);
  }
}

}  // namespace
}  // namespace semantic_mht_slam
