#include "semantic_mht_slam/registration/registration_config.h"

namespace semantic_mht_slam {
namespace {

void describeSearch(RegistrationConfig& config, Fields& fields) {
  using Search = RegistrationSearch;
  fields.add("search", config.search,
             {{"votes", Search::kVotes}, {"clique", Search::kClique}, {"ransac", Search::kRansac}},
             "First guesses: votes of points, or of pairs of points where the heading is open; maximum clique of "
             "correspondences; or random samples (PCL).");
  fields.add("max_offset", config.max_offset_m, "m", {0.1, 60.0},
             "Without a prior: two frames further apart than this are not compared.");
  fields.add("window_sigmas", config.window_sigmas, "", {0.5, 6.0},
             "With a prior: offsets are looked for within so many of its standard deviations.");
  fields.add("max_window", config.max_window_m, "m", {1.0, 200.0},
             "But not beyond this shift; bounds time and memory.");
  fields.add("cell", config.cell_m, "m", {0.05, 5.0},
             "Side of a cell of the voting grid; three times this without a prior.");
  fields.add("yaw_step", config.yaw_step_rad, "rad", {0.001, 0.2},
             "Heading step of the voting grid; five times this without a prior.");
  fields.add("max_seeds", config.max_seeds, "", {1, 1000}, "Peaks of the voting grid that are refined.");
  fields.add("max_modes", config.max_modes, "", {1, 100}, "Most alignments returned.");
  fields.add("min_matches", config.min_matches, "", {2, 1000}, "Fewest pairs of an alignment.");
  fields.add("distinct", config.distinct_m, "m", {0.0, 100.0}, "Alignments nearer than this are one,");
  fields.add("distinct_yaw", config.distinct_rad, "rad", {0.0, 3.2}, "if their headings are nearer than this.");
}

}  // namespace

void describe(RegistrationConfig& config, Fields& fields) {
  describeSearch(config, fields);
  fields.add("static_match_prob", config.static_match_prob, "", {0.01, 0.99},
             "Probability that an object of a static class is found again.");
  fields.add("movable_match_prob", config.movable_match_prob, "", {0.01, 0.99},
             "The same for classes that may drive away.");
  fields.add("match_concentration", config.match_concentration, "", {0.01, 1e4},
             "How sure these two shares are: as if learned from so many objects.");
  fields.add("confusion_prob", config.confusion_prob, "", {0.0, 0.9},
             "Probability that the detector mistakes the class for another, static or movable as the true one.");
  fields.add("noise_floor", config.noise_floor_m, "m", {1e-3, 10.0},
             "Standard deviation of what covariances leave out: centroid bias, bending of the map.");
  fields.add("height_stddev", config.height_stddev_m, "m", {0.0, 100.0},
             "Further standard deviation of an object's height: from elsewhere, another part of it is seen.");
  fields.add("tilt_stddev", config.tilt_stddev_rad, "rad", {1e-4, 0.5},
             "Standard deviation of roll and pitch, each, between two passes.");
  fields.add("density_radius", config.density_radius_m, "m", {1.0, 1000.0},
             "The density of objects, for chance matches, is counted so far around them.");
  fields.add("density_height", config.density_height_m, "m", {0.1, 100.0}, "Height that objects are spread over.");
}

}  // namespace semantic_mht_slam
