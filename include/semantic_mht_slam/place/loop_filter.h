#pragma once

#include "semantic_mht_slam/common/config.h"

namespace semantic_mht_slam {

class StateArchive;

/// Transitions and observation likelihoods of the loop filter. The transitions are those of Angeli et al., "Fast and
/// Incremental Method for Loop-Closure Detection Using Bags of Visual Words" (IEEE T-RO 2008).
struct LoopFilterConfig {
  double enter_prob = 0.1;       ///< P(loop | no loop before)
  double stay_prob = 0.9;        ///< P(loop | loop before)
  double hit_prob = 0.6;         ///< P(scores pass | loop)
  double false_hit_prob = 0.05;  ///< P(scores pass | no loop)
  double min_loop_prob = 0.75;   ///< belief at which a loop closure is taken for one
};

void describe(LoopFilterConfig& config, Fields& fields);

/// Discrete Bayes filter over two states, "this is a place seen before" and "it is not" (paper, section III-B): one
/// passing candidate among many that fail is not believed, several in a row are.
class LoopFilter {
 public:
  explicit LoopFilter(const LoopFilterConfig& config) : config_(config) {}

  /// One keyframe further: predicts, then takes in whether the scores of its best candidate pass. Returns the
  /// probability of a loop.
  double update(bool passes);

  /// Probability of a loop after the last update; 0 before the first.
  double loopProb() const { return loop_prob_; }

  /// True if a loop is believed in.
  bool believes() const { return loop_prob_ >= config_.min_loop_prob; }

  /// Forgets everything, as after a gap in the drive.
  void reset() { loop_prob_ = 0.0; }

  /// The belief (see `StateArchive`).
  void transfer(StateArchive& archive);

 private:
  LoopFilterConfig config_;
  double loop_prob_ = 0.0;
};

}  // namespace semantic_mht_slam
