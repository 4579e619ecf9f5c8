#pragma once

namespace semantic_mht_slam {

/// When two maps are believed to show one place. Lengths are those of a detector that sees as far as the reference.
/// Chosen on simulated towns, streets and halls, never on recorded drives.
struct MergeConfig {
  double window_m = 10.0;          ///< before and behind a keyframe: what is seen there is compared as one scene
  double window_spacing_m = 10.0;  ///< between two such scenes
  int candidates_per_window = 3;   ///< most alike scenes of the other map that are laid onto it
  int candidates_per_pair = 400;   ///< and of two maps in all
  int modes_per_candidate = 2;     ///< ways to lay a scene onto another that are kept
  int min_pairs = 6;               ///< landmarks that a candidate pairs
  int max_hypotheses = 6;          ///< of where a map lies in another
  int tile_landmarks = 12;         ///< of a tile: what bears witness once
  int min_tile_landmarks = 6;
  double tile_stddev_m = 1.0;  ///< least deviation of where a tile is looked for
  double tile_stddev_rad = 0.05;
  int max_tiles = 40;               ///< that are asked; the nearest to what is known come first
  double seen_within_m = 15.0;      ///< what a vehicle came so near to, it has seen
  double found_prob = 0.93;         ///< that a tile is found that the other vehicle came near
  double max_log_odds = 1.2;        ///< that a landmark with a counterpart counts at most, nats
  double rival_temper = 3.0;        ///< neighbouring landmarks are not independent: what two hypotheses differ by
  double join_prob = 0.999;         ///< posterior from which on two maps are joined
  int join_landmarks = 10;          ///< that must have counterparts then
  double max_missing_share = 0.15;  ///< of what should be in common; streets that look alike miss more
  int spread_tiles = 1;             ///< that must be found besides the scene that a hypothesis began with;
  double whole_share = 0.5;         ///< both do not matter if that share of one of the maps has counterparts
  double min_holding = 0.5;         ///< share of the closures between two joined maps that the graph must bear out
  double agree_m = 2.0;             ///< two hypotheses that differ by less, and what odometry may have drifted, are one
  double agree_rad = 0.06;
  double confidence_gate = 11.34;  ///< 99 % quantile of chi-square with 3 degrees of freedom
};

}  // namespace semantic_mht_slam
