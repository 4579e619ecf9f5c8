#include "semantic_mht_slam/simulation/scenario.h"

#include "semantic_mht_slam/common/error.h"

namespace semantic_mht_slam {
namespace {

constexpr Range kProb = {0.0, 1.0};

void requireOrder(double min, double max, const std::string& key, std::vector<std::string>& problems) {
  if (min > max) problems.push_back(key + "_min is above " + key + "_max");
}

}  // namespace

void describe(StreetNetworkConfig& c, Fields& fields) {
  fields.add("columns", c.columns, "", {2, 40}, "Corners from west to east.");
  fields.add("rows", c.rows, "", {2, 40}, "Corners from south to north.");
  fields.add("block_width", c.block_width_m, "m", {50, 500}, "Mean distance between neighbouring columns.");
  fields.add("block_depth", c.block_depth_m, "m", {50, 500}, "Mean distance between neighbouring rows.");
  fields.add("irregularity", c.irregularity, "", {0, 0.3}, "Largest shift of a corner as a share of the block size.");
  fields.add("bend", c.bend_m, "m", {0, 15}, "Largest sideways bulge of a street.");
  fields.add("removed_street_prob", c.removed_street_prob, "", kProb,
             "Chance that a street is left out, where the network stays connected without it.");
  fields.add("main_road_every", c.main_road_every, "", {0, 40},
             "Every n-th row and column is a main road; 0 for none.");
  fields.add("green_prob", c.green_prob, "", kProb, "Chance that a street that is no main road leads through a park.");
  fields.add("lookalike_prob", c.lookalike_prob, "", kProb,
             "Chance that a street repeats the objects of the parallel street one block before it.");
  fields.add("lookalike_jitter", c.lookalike_jitter_m, "m", {0, 10},
             "Standard deviation of the place of a repeated object, along and across the street.");
  fields.add("hill_height", c.hill_height_m, "m", {0, 20}, "Largest height of the ground above or below its mean.");
  fields.add("hill_length", c.hill_length_m, "m", {100, 5000}, "Shortest wavelength of the ground.");
}

void describe(PassesConfig& c, Fields& fields) {
  fields.add("radius", c.radius_m, "m", {10, 300},
             "A pass of an object lasts while the sensor is within this distance.");
  fields.add("gap", c.gap_s, "s", {0, 600}, "A shorter absence does not end a pass.");
  fields.add("parking_occupancy_prob", c.parking_occupancy_prob, "", kProb, "Chance that a parking place is taken.");
  fields.add("parking_stay_prob", c.parking_stay_prob, "", kProb,
             "Chance that nothing changes at a parking place between two passes.");
  fields.add("parking_jitter", c.parking_jitter_m, "m", {0, 3},
             "Standard deviation of a car's place within its parking place, along the street.");
}

void describe(TrafficConfig& c, Fields& fields) {
  fields.add("oncoming_per_minute", c.oncoming_per_minute, "1/min", {0, 60},
             "Mean number of cars that come towards the sensor.");
  fields.add("leading_per_minute", c.leading_per_minute, "1/min", {0, 60}, "Mean number of cars that appear ahead.");
  fields.add("leading_duration", c.leading_duration_s, "s", {0, 300}, "Mean time for which a car leads.");
  fields.add("speed", c.speed_mps, "m/s", {1, 40}, "Speed of oncoming cars.");
  fields.add("lane_width", c.lane_width_m, "m", {0, 10}, "Distance of oncoming cars from the path of the sensor.");
}

void describe(RouteConfig& c, Fields& fields) {
  fields.add("length", c.length_m, "m", {50, 1000000}, "Length of the drive.");
  fields.add("round", c.round_m, "m", {0, 100000},
             "Length after which the drive goes back to where it began and is made again; 0: never.");
  fields.add("same_direction_fraction", c.same_direction_fraction, "", {0, 0.9},
             "Share of the drive on streets that were driven before in the same direction.");
  fields.add("opposite_direction_fraction", c.opposite_direction_fraction, "", {0, 0.9},
             "Share of the drive on streets that were driven before in the opposite direction only.");
  fields.add("min_loop", c.min_loop_m, "m", {100, 10000}, "Shortest drive before a street is sought again.");
  fields.add("revisit_run", c.revisit_run_m, "m", {1, 10000},
             "Mean length for which an earlier part of the drive is followed.");
  fields.add("lane_offset", c.lane_offset_m, "m", {0, 2}, "Distance from the centre line, to the right.");
  fields.add("lateral_wander_stddev", c.lateral_wander_stddev_m, "m", {0, 1}, "Wander across the lane.");
  fields.add("corner_radius", c.corner_radius_m, "m", {3, 8}, "Smallest radius in a right-angled turn.");
  fields.add("cruise_speed", c.cruise_speed_mps, "m/s", {2, 30}, "Speed on straight streets.");
  fields.add("lateral_acceleration", c.lateral_acceleration_mps2, "m/s^2", {0.2, 10}, "Largest in a curve.");
  fields.add("acceleration", c.acceleration_mps2, "m/s^2", {0.2, 10}, "Largest when speeding up or braking.");
  fields.add("stop_prob", c.stop_prob, "", kProb, "Chance to stop before a corner.");
  fields.add("stop_duration_max", c.stop_duration_max_s, "s", {0, 60}, "Longest stop.");
  fields.add("frame_rate", c.frame_rate_hz, "Hz", {1, 100}, "Frames a second.");
  fields.add("sensor_height", c.sensor_height_m, "m", {0, 5}, "Height of the sensor above the road.");
  fields.add("tilt_stddev", c.tilt_stddev_rad, "rad", {0, 0.1}, "Pitch and roll of the vehicle on its springs.");
}

void describe(SimulatedDetectorConfig& c, Fields& fields) {
  fields.add("max_range", c.max_range_m, "m", {5, 300}, "Nothing is detected beyond.");
  fields.add("field_of_view", c.field_of_view_rad, "rad", {0.1, 6.283185307179587}, "Horizontal, centred forward.");
  fields.add("range_falloff", c.range_falloff_m, "m", {0.1, 100},
             "Width of the logistic fall of the detection probability around a class's half_range.");
  fields.add("buildings_block_view", c.buildings_block_view, "Objects behind a building are not seen.");
  fields.add("hidden_pass_prob", c.hidden_pass_prob, "", kProb, "Chance that an object is hidden during a whole pass.");
  fields.add("range_stddev_per_m", c.range_stddev_per_m, "", {0, 0.5},
             "Depth noise that grows with range, on top of the noise of the class.");
  fields.add("confusion_prob", c.confusion_prob, "", kProb,
             "Chance that a detection has the class of a similar thing.");
  fields.add("split_prob", c.split_prob, "", kProb, "Chance that an object is detected in two parts.");
  fields.add("split_distance", c.split_distance_m, "m", {0, 10}, "Largest distance between the two parts.");
  fields.add("clutter_mean", c.clutter_mean, "", {0, 100},
             "Mean number of detections of nothing in a frame (Poisson).");
  fields.add("missed_frame_prob", c.missed_frame_prob, "", kProb, "Chance that a frame has no detections at all.");
}

void describe(SimulatedOdometryConfig& c, Fields& fields) {
  fields.add("heading_noise", c.heading_noise_rad_per_sqrt_m, "rad/sqrt(m)", {0, 0.1},
             "White noise of the heading rate.");
  fields.add("heading_bias", c.heading_bias_rad_per_m, "rad/m", {0, 0.01},
             "Standard deviation of the heading rate's bias.");
  fields.add("tilt_noise", c.tilt_noise_rad_per_sqrt_m, "rad/sqrt(m)", {0, 0.1},
             "White noise of the pitch and roll rates.");
  fields.add("tilt_bias", c.tilt_bias_rad_per_m, "rad/m", {0, 0.01},
             "Standard deviation of the pitch and roll rates' biases.");
  fields.add("bias_length", c.bias_length_m, "m", {1, 10000},
             "Distance over which the biases and the scale stay alike.");
  fields.add("translation_noise", c.translation_noise_m_per_sqrt_m, "m/sqrt(m)", {0, 1},
             "White noise of the translation, each axis.");
  fields.add("scale_stddev", c.scale_stddev, "", {0, 0.2}, "Standard deviation of the scale error of a drive.");
  fields.add("scale_variation_stddev", c.scale_variation_stddev, "", {0, 0.2},
             "Standard deviation of the scale within a drive.");
  fields.add("direction_stddev", c.direction_stddev_rad, "rad", {0, 0.1},
             "Pitch and yaw between the sensor and its direction of travel, constant in a drive.");
}

void describe(Scenario& scenario, Fields& fields) {
  fields.group("network", scenario.network);
  fields.group("classes", scenario.classes);
  fields.group("passes", scenario.passes);
  fields.group("traffic", scenario.traffic);
  fields.group("route", scenario.route);
  fields.group("detector", scenario.detector);
  fields.group("odometry", scenario.odometry);
}

void validate(const Scenario& scenario) {
  Scenario copy = scenario;
  Fields fields;
  describe(copy, fields);
  std::vector<std::string> problems;
  for (const Field& field : fields.all()) {
    const std::string value = field.get();
    if (const auto problem = field.set(value)) problems.push_back(field.key + " = '" + value + "' " + *problem);
  }
  for (std::size_t i = 0; i < scenario.classes.items.size(); ++i) {
    const TownClassConfig& item = scenario.classes.items[i];
    const std::string key = std::string("classes.") + kTownClassNames[i];
    requireOrder(item.setback_min_m, item.setback_max_m, key + ".setback", problems);
    requireOrder(item.length_min_m, item.length_max_m, key + ".length", problems);
  }
  if (scenario.detector.max_range_m > scenario.passes.radius_m) {
    problems.push_back("detector.max_range is above passes.radius");
  }
  if (scenario.route.same_direction_fraction + scenario.route.opposite_direction_fraction > 0.9) {
    problems.push_back("route.same_direction_fraction and route.opposite_direction_fraction sum to more than 0.9");
  }
  if (!problems.empty()) throw ConfigError(problems);
}

}  // namespace semantic_mht_slam
