#include "semantic_mht_slam/place/loop_filter.h"

namespace semantic_mht_slam {

void describe(LoopFilterConfig& config, Fields& fields) {
  // Certainties are refused: a filter that excludes something never learns better.
  const Range open{0.001, 0.999};
  fields.add("enter_prob", config.enter_prob, "", open, "Probability that a loop begins at a keyframe.");
  fields.add("stay_prob", config.stay_prob, "", open, "Probability that a loop goes on at the next keyframe.");
  fields.add("hit_prob", config.hit_prob, "", open, "Probability that the scores pass in a loop.");
  fields.add("false_hit_prob", config.false_hit_prob, "", open, "Probability that the scores pass without a loop.");
  fields.add("min_loop_prob", config.min_loop_prob, "", open,
             "Belief in a loop from which on a candidate is proposed.");
}

double LoopFilter::update(bool passes) {
  const double prior = config_.stay_prob * loop_prob_ + config_.enter_prob * (1.0 - loop_prob_);
  const double if_loop = passes ? config_.hit_prob : 1.0 - config_.hit_prob;
  const double if_none = passes ? config_.false_hit_prob : 1.0 - config_.false_hit_prob;
  const double evidence = if_loop * prior + if_none * (1.0 - prior);
  loop_prob_ = if_loop * prior / evidence;
  return loop_prob_;
}

}  // namespace semantic_mht_slam
