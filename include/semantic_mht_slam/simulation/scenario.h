#pragma once

#include <array>

#include "semantic_mht_slam/common/config.h"

namespace semantic_mht_slam {

/// What stands in the simulated town. The names are those of SemanticKITTI.
enum class TownClass { kVehicle, kBuilding, kFence, kVegetation, kTrunk, kPole, kTrafficSign };

constexpr int kTownClassCount = 7;
constexpr std::array<const char*, kTownClassCount> kTownClassNames = {
    "vehicle", "building", "fence", "vegetation", "trunk", "pole", "traffic_sign"};

/// Streets on an irregular grid over gentle hills.
struct StreetNetworkConfig {
  int columns = 6;
  int rows = 5;
  double block_width_m = 110.0;
  double block_depth_m = 85.0;
  double irregularity = 0.15;
  double bend_m = 5.0;
  double removed_street_prob = 0.1;
  int main_road_every = 3;
  double green_prob = 0.15;
  double lookalike_prob = 0.0;
  double lookalike_jitter_m = 0.3;
  double hill_height_m = 2.5;
  double hill_length_m = 300.0;
};

/// How one class stands along the streets and how the detector sees it.
struct TownClassConfig {
  double residential_density = 0.0;  ///< objects per 100 m of street, both sides together
  double main_density = 0.0;
  double green_density = 0.0;
  double setback_min_m = 4.0;  ///< from the centre line to the nearest face
  double setback_max_m = 8.0;
  double length_min_m = 0.0;  ///< along the street
  double length_max_m = 0.0;
  double depth_m = 0.0;   ///< across the street
  double height_m = 1.0;  ///< of the centroid above the road
  double height_stddev_m = 0.2;
  double spacing_m = 3.0;  ///< free length between two of the class on one side
  double detection_prob = 0.95;
  double half_range_m = 25.0;
  double range_stddev_m = 0.07;
  double lateral_stddev_m = 0.07;
  double height_noise_stddev_m = 0.07;
  double range_bias_m = 0.0;
  double range_bias_per_m = 0.0;
  double height_bias_per_m = 0.0;
  double view_dependence = 0.0;
};

/// One config a class, in the order of TownClass. The defaults follow KITTI sequence 05 as a Velodyne sees it.
struct TownClassesConfig {
  TownClassesConfig();

  TownClassConfig& operator[](TownClass town_class) { return items[static_cast<std::size_t>(town_class)]; }
  const TownClassConfig& operator[](TownClass town_class) const { return items[static_cast<std::size_t>(town_class)]; }

  std::array<TownClassConfig, kTownClassCount> items;
};

/// A pass is the time from coming near a place to leaving it. Cars park and leave between two passes.
struct PassesConfig {
  double radius_m = 60.0;
  double gap_s = 20.0;
  double parking_occupancy_prob = 0.7;
  double parking_stay_prob = 0.5;
  double parking_jitter_m = 0.4;
};

/// Cars that move.
struct TrafficConfig {
  double oncoming_per_minute = 10.0;
  double leading_per_minute = 3.0;
  double leading_duration_s = 15.0;
  double speed_mps = 9.0;
  double lane_width_m = 3.0;
};

/// Where and how the sensor is driven.
struct RouteConfig {
  double length_m = 3000.0;
  double round_m = 0.0;
  double same_direction_fraction = 0.18;
  double opposite_direction_fraction = 0.12;
  double min_loop_m = 300.0;
  double revisit_run_m = 250.0;
  double lane_offset_m = 1.0;
  double lateral_wander_stddev_m = 0.15;
  double corner_radius_m = 6.0;
  double cruise_speed_mps = 9.0;
  double lateral_acceleration_mps2 = 2.0;
  double acceleration_mps2 = 1.5;
  double stop_prob = 0.15;
  double stop_duration_max_s = 1.5;
  double frame_rate_hz = 10.0;
  double sensor_height_m = 1.73;
  double tilt_stddev_rad = 0.004;
};

/// What the detector makes of the town, apart from the class-specific values.
struct SimulatedDetectorConfig {
  double max_range_m = 50.0;
  double field_of_view_rad = 6.283185307179586;
  double range_falloff_m = 7.0;
  bool buildings_block_view = true;
  double hidden_pass_prob = 0.1;
  double range_stddev_per_m = 0.0;
  double confusion_prob = 0.03;
  double split_prob = 0.0;
  double split_distance_m = 1.0;
  double clutter_mean = 0.4;
  double missed_frame_prob = 0.002;
};

/// Drift of the odometry: white noise and slowly varying (Ornstein-Uhlenbeck) biases a metre driven.
struct SimulatedOdometryConfig {
  double heading_noise_rad_per_sqrt_m = 0.00045;
  double heading_bias_rad_per_m = 0.00003;
  double tilt_noise_rad_per_sqrt_m = 0.0004;
  double tilt_bias_rad_per_m = 0.00003;
  double bias_length_m = 50.0;
  double translation_noise_m_per_sqrt_m = 0.01;
  double scale_stddev = 0.003;
  double scale_variation_stddev = 0.004;
  double direction_stddev_rad = 0.0035;
};

/// Everything a simulated drive is made from, but the seed. The defaults are the demo: a small town, about 3 km, a
/// lidar-grade detector and visual odometry.
struct Scenario {
  StreetNetworkConfig network;
  TownClassesConfig classes;
  PassesConfig passes;
  TrafficConfig traffic;
  RouteConfig route;
  SimulatedDetectorConfig detector;
  SimulatedOdometryConfig odometry;
};

void describe(StreetNetworkConfig& config, Fields& fields);
void describe(TownClassConfig& config, Fields& fields);
void describe(TownClassesConfig& config, Fields& fields);
void describe(PassesConfig& config, Fields& fields);
void describe(TrafficConfig& config, Fields& fields);
void describe(RouteConfig& config, Fields& fields);
void describe(SimulatedDetectorConfig& config, Fields& fields);
void describe(SimulatedOdometryConfig& config, Fields& fields);
void describe(Scenario& scenario, Fields& fields);

/// Throws ConfigError naming every value out of its range and every pair of values that contradict each other.
void validate(const Scenario& scenario);

}  // namespace semantic_mht_slam
