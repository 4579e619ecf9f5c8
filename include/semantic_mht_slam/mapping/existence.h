#pragma once

#include "semantic_mht_slam/mapping/hypothesis.h"

namespace semantic_mht_slam {

/// Existence of a landmark by hits and misses. An object is visible or hidden (behind a truck, a wall), and stays so
/// for a while: a two-state Markov chain. Visible, it is detected with probability P_D; hidden, never. What does not
/// exist is hit at the rate of clutter. A run of misses therefore costs little more than one occlusion, but hits with
/// misses between them are weak evidence, as they are what clutter gives.

/// P(visible) one frame later; `switch_prob` is the chance of being hidden or uncovered within a frame.
double predictedVisibility(double visible_prob, double switch_prob);

/// After a frame in which the landmark was in range and not detected. Returns the likelihood of the miss if it exists.
double applyMiss(Existence& existence, double detection_prob, double switch_prob);

/// After a detection; `log_density_ratio` is log of the detection's density at the landmark over that of clutter.
/// The odds stay below `max_log_odds`.
void applyHit(Existence& existence, double detection_prob, double switch_prob, double log_density_ratio,
              double max_log_odds);

}  // namespace semantic_mht_slam
