#include "semantic_mht_slam/place/place_config.h"

namespace semantic_mht_slam {
namespace {

void describeChecks(PlaceConfig& config, Fields& fields) {
  fields.add("full_residual", config.full_residual_m, "m", {0.01, 10.0},
             "Objects nearer than this to their counterpart count fully as inliers.");
  fields.add("movable_weight", config.movable_weight, "", {0.0, 1.0}, "What an object that may drive away counts.");
  fields.add("min_inliers", config.min_inliers, "", {2, 1000}, "Least number of objects that lie on each other.");
  fields.add("min_classes", config.min_classes, "", {1, 32}, "Least number of classes among them.");
  fields.add("min_spread", config.min_spread_m, "m", {0.0, 100.0},
             "Least deviation of them from the line that fits them best.");
  fields.add("max_stddev", config.max_stddev_m, "m", {0.01, 100.0},
             "Horizontal deviation of the transform above which it is refused.");
  fields.add("max_stddev_angle", config.max_stddev_rad, "rad", {0.001, 3.2}, "The same of its heading.");
  fields.add("min_share", config.min_share, "", {0.0, 1.0}, "Least share of the smaller scene that lies on the other.");
  fields.add("min_log_evidence", config.min_log_evidence, "nats", {-1e6, 1e6},
             "Least logarithm of how much likelier one place is than chance, objects without counterpart included.");
  fields.add("supported_score", config.supported_score, "", {0.0, 1000.0},
             "Verification score that is enough if the match of a neighbouring keyframe agrees.");
  fields.add("lone_score", config.lone_score, "", {0.0, 1000.0}, "Verification score that is enough alone.");
  fields.add("far_factor", config.far_factor, "", {0.0, 100.0},
             "How much more `lone_score` is at the edge of the drift gate, and without a gate.");
  fields.add("rival_ratio", config.rival_ratio, "", {0.0, 1.0},
             "A match is refused if another alignment or place has this part of its score.");
  fields.add(
      "agree_distance", config.agree_m, "m", {0.01, 100.0},
      "Matches of neighbouring keyframes agree if they differ by less than this and 2 % of the way between; so do two "
      "alignments of one pair of keyframes that are no rivals.");
  fields.add("agree_angle", config.agree_rad, "rad", {0.001, 3.2}, "The same of their headings.");
  fields.add("support_reach", config.support_reach_m, "m", {0.0, 10000.0},
             "Keyframes this far apart, by distance driven, are neighbours.");
}

}  // namespace

void describe(PlaceConfig& config, Fields& fields) {
  fields.add<PlaceChain>("chain", config.chain,
                         {{"pair_distance", PlaceChain::kPairDistance}, {"paper", PlaceChain::kPaper}},
                         "What picks the keyframes that are verified: distances of pairs of objects, or the paper's "
                         "histograms, scores and filter.");
  fields.add("recent", config.recent_m, "m", {0.0, 1e6},
             "Keyframes driven through less than this before are no revisit.");
  fields.add("drift_gate", config.drift_gate,
             "Whether only places are searched that drift may have brought to the present estimate.");
  fields.add("gate_base", config.gate_base_m, "m", {0.0, 1e6}, "Radius of that gate without drift.");
  fields.add("gate_per_driven", config.gate_per_driven_m, "m/m", {0.0, 1.0},
             "Its growth with the distance driven since.");
  fields.add("max_compared", config.max_compared, "", {1, 1000000},
             "Nearest keyframes whose descriptors are compared.");
  fields.add("max_candidates", config.max_candidates, "", {1, 1000}, "Keyframes most alike that are aligned.");
  fields.add("min_descriptor_score", config.min_descriptor_score, "", {0.0, 1.0}, "Least similarity of descriptors.");
  describeChecks(config, fields);
  fields.group("descriptor", config.descriptor);
  fields.group("paper", config.paper);
}

}  // namespace semantic_mht_slam
