#include "semantic_mht_slam/simulation/scenario.h"

namespace semantic_mht_slam {
namespace {

constexpr Range kProb = {0.0, 1.0};

void setDensities(TownClassConfig& config, double residential, double main, double green) {
  config.residential_density = residential;
  config.main_density = main;
  config.green_density = green;
}

void setPlace(TownClassConfig& config, double setback_min_m, double setback_max_m, double height_m,
              double height_stddev_m) {
  config.setback_min_m = setback_min_m;
  config.setback_max_m = setback_max_m;
  config.height_m = height_m;
  config.height_stddev_m = height_stddev_m;
}

void setBox(TownClassConfig& config, double length_min_m, double length_max_m, double depth_m, double spacing_m) {
  config.length_min_m = length_min_m;
  config.length_max_m = length_max_m;
  config.depth_m = depth_m;
  config.spacing_m = spacing_m;
}

void setNoise(TownClassConfig& config, double horizontal_m, double vertical_m) {
  config.range_stddev_m = horizontal_m;
  config.lateral_stddev_m = horizontal_m;
  config.height_noise_stddev_m = vertical_m;
}

TownClassConfig vehicle() {
  TownClassConfig config;
  setDensities(config, 30.0, 10.0, 8.0);
  setPlace(config, 2.9, 3.6, 0.75, 0.15);
  setBox(config, 4.0, 4.8, 1.8, 0.8);
  setNoise(config, 0.18, 0.15);
  config.half_range_m = 20.0;
  config.range_bias_m = -0.2;
  config.range_bias_per_m = -0.008;
  return config;
}

TownClassConfig building() {
  TownClassConfig config;
  setDensities(config, 6.5, 6.5, 1.0);
  setPlace(config, 8.5, 12.0, 2.9, 0.5);
  setBox(config, 10.0, 24.0, 9.0, 1.5);
  setNoise(config, 0.4, 0.33);
  config.half_range_m = 29.0;
  config.view_dependence = 1.0;
  return config;
}

TownClassConfig fence() {
  TownClassConfig config;
  setDensities(config, 7.0, 5.0, 6.0);
  setPlace(config, 6.5, 8.0, 0.75, 0.3);
  setBox(config, 5.0, 14.0, 0.2, 1.5);
  setNoise(config, 0.33, 0.28);
  config.half_range_m = 29.0;
  config.view_dependence = 0.5;
  return config;
}

TownClassConfig vegetation() {
  TownClassConfig config;
  setDensities(config, 11.0, 7.0, 24.0);
  setPlace(config, 6.0, 18.0, 1.3, 0.6);
  setNoise(config, 0.36, 0.23);
  config.half_range_m = 22.0;
  return config;
}

TownClassConfig trunk() {
  TownClassConfig config;
  setDensities(config, 7.5, 6.0, 14.0);
  setPlace(config, 4.6, 12.0, 1.5, 0.3);
  config.range_bias_m = -0.05;
  config.range_bias_per_m = -0.0015;
  config.height_bias_per_m = 0.01;
  return config;
}

TownClassConfig pole() {
  TownClassConfig config;
  setDensities(config, 5.0, 10.0, 4.5);
  setPlace(config, 4.2, 7.0, 1.3, 0.3);
  config.spacing_m = 6.0;
  config.range_bias_m = -0.04;
  config.range_bias_per_m = -0.001;
  config.height_bias_per_m = 0.01;
  return config;
}

TownClassConfig trafficSign() {
  TownClassConfig config;
  setDensities(config, 0.8, 3.0, 0.6);
  setPlace(config, 4.2, 6.5, 1.95, 0.4);
  config.spacing_m = 6.0;
  config.half_range_m = 18.0;
  return config;
}

}  // namespace

TownClassesConfig::TownClassesConfig()
    : items{vehicle(), building(), fence(), vegetation(), trunk(), pole(), trafficSign()} {}

void describe(TownClassConfig& c, Fields& fields) {
  fields.add("residential_density", c.residential_density, "1/100 m", {0, 40},
             "Objects along a residential street, both sides together; for vehicles places to park.");
  fields.add("main_density", c.main_density, "1/100 m", {0, 40}, "Objects along a main road.");
  fields.add("green_density", c.green_density, "1/100 m", {0, 40}, "Objects along a street through a park.");
  fields.add("setback_min", c.setback_min_m, "m", {0, 40},
             "Smallest distance of the nearest face from the street's centre line.");
  fields.add("setback_max", c.setback_max_m, "m", {0, 40},
             "Largest distance of the nearest face from the street's centre line.");
  fields.add("length_min", c.length_min_m, "m", {0, 40}, "Smallest length along the street.");
  fields.add("length_max", c.length_max_m, "m", {0, 40}, "Largest length along the street.");
  fields.add("depth", c.depth_m, "m", {0, 40}, "Depth across the street.");
  fields.add("height", c.height_m, "m", {0, 20}, "Mean height of the centroid above the road.");
  fields.add("height_stddev", c.height_stddev_m, "m", {0, 5}, "Standard deviation of that height between objects.");
  fields.add("spacing", c.spacing_m, "m", {0, 50}, "Free length between two of the class on one side of a street.");
  fields.add("detection_prob", c.detection_prob, "", kProb, "Chance to be detected from close by.");
  fields.add("half_range", c.half_range_m, "m", {1, 200}, "Range at which half of that chance is left.");
  fields.add("range_stddev", c.range_stddev_m, "m", {0, 10}, "Noise of the centroid along the line of sight.");
  fields.add("lateral_stddev", c.lateral_stddev_m, "m", {0, 10}, "Noise of the centroid across the line of sight.");
  fields.add("height_noise_stddev", c.height_noise_stddev_m, "m", {0, 10}, "Noise of the height of the centroid.");
  fields.add("range_bias", c.range_bias_m, "m", {-5, 5},
             "Shift of the centroid along the line of sight; negative because the near side is seen.");
  fields.add("range_bias_per_m", c.range_bias_per_m, "", {-0.1, 0.1}, "Growth of that shift with range.");
  fields.add("height_bias_per_m", c.height_bias_per_m, "", {-0.1, 0.1},
             "Rise of the centroid with range, from low parts being hidden far away.");
  fields.add("view_dependence", c.view_dependence, "", kProb,
             "0: the centre of the object is seen; 1: the centroid of its visible faces.");
}

void describe(TownClassesConfig& config, Fields& fields) {
  for (std::size_t i = 0; i < config.items.size(); ++i) fields.group(kTownClassNames[i], config.items[i]);
}

}  // namespace semantic_mht_slam
