#pragma once

#include <vector>

#include "semantic_mht_slam/common/k_best_assignment.h"
#include "semantic_mht_slam/common/random.h"
#include "semantic_mht_slam/mapping/association.h"
#include "semantic_mht_slam/mapping/frame_interpretation.h"
#include "semantic_mht_slam/mapping/hypothesis.h"
#include "semantic_mht_slam/mapping/landmark_tracking.h"
#include "semantic_mht_slam/mapping/map_branching.h"
#include "semantic_mht_slam/mapping/mapper_config.h"

namespace semantic_mht_slam {

class StateArchive;

/// A measurement of the base frame as it is in the submap's; with an offset, its uncertainty is in the covariance, too.
Measurement inSubmap(Measurement measurement, const Pose& T_submap_base, const PoseOffset* offset);

/// The multiple-hypothesis tree of one submap (paper, section II): its leaves, weighted, by falling weight.
class MultiHypothesisTree {
 public:
  MultiHypothesisTree(const MapperConfig& config, const ClassTable& classes,
                      const RegistrationConfig& registration = {});

  /// Starts again from one hypothesis, in surroundings that an earlier map may show.
  void restart(std::vector<HypothesisLandmark> landmarks, EarlierMap earlier_map = {});

  /// Grows every leaf by its likely assignments, weighs, merges, drops and resamples.
  void step(const TreeInput& input, Rng& rng);

  /// The leaves; the first is the most likely one. Never empty.
  const std::vector<MapHypothesis>& leaves() const { return leaves_; }

  /// What is known of the probability of detection; learns from finished submaps.
  DetectionRate& detectionRate() { return tracking_.detectionRate(); }

  /// How the detector confuses classes, and how often it shows nothing; both learn from finished submaps.
  ClassConfusion& confusion() { return model_.confusion(); }
  ClutterModel& clutter() { return model_.clutter(); }
  NeighbourDensity& neighbours() { return model_.neighbours(); }

  /// How likely associations are.
  const AssociationModel& model() const { return model_; }

  /// Where the submap lies in the earlier map.
  const MapBranching& mapBranching() const { return branching_; }

  /// The leaves and all that was learned (see `StateArchive`).
  void transfer(StateArchive& archive);

 private:
  void measureFrom(const Pose& T_submap_base, const PoseOffset* offset, const TreeInput& input,
                   std::vector<Measurement>& measurements) const;
  PoseOffset offsetAfter(const FrameInterpretation& interpretation, const TreeInput& input) const;
  void expand(std::size_t leaf, const TreeInput& input, std::vector<FrameInterpretation>& interpretations);
  std::vector<MapHypothesis> makeChildren(const std::vector<FrameInterpretation>& interpretations,
                                          const TreeInput& input);
  /// The last child takes the landmarks of its parent, the others copy them.
  MapHypothesis makeChild(const FrameInterpretation& interpretation, const TreeInput& input, bool is_last);
  void trackLandmarks(const FrameInterpretation& interpretation, const TreeInput& input, MapHypothesis& child) const;

  MapperConfig config_;
  AssociationModel model_;
  LandmarkTracking tracking_;
  MapBranching branching_;
  KBestSolver solver_;
  std::vector<LeafExpansion> expansions_;  ///< of each leaf
  std::vector<Measurement> corrected_;     ///< submap frame, corrected pose
  std::vector<MapHypothesis> leaves_;
  std::uint64_t next_hypothesis_id_ = 1;
};

}  // namespace semantic_mht_slam
