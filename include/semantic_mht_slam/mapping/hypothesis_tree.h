#pragma once

#include <vector>

#include "semantic_mht_slam/common/k_best_assignment.h"
#include "semantic_mht_slam/common/random.h"
#include "semantic_mht_slam/mapping/association.h"
#include "semantic_mht_slam/mapping/hypothesis.h"
#include "semantic_mht_slam/mapping/landmark_tracking.h"
#include "semantic_mht_slam/mapping/map_branching.h"
#include "semantic_mht_slam/mapping/mapper_config.h"

namespace semantic_mht_slam {

class StateArchive;

/// The multiple-hypothesis tree of one submap (paper, section II): its leaves, weighted, by falling weight.
class MultiHypothesisTree {
 public:
  MultiHypothesisTree(const MapperConfig& config, const ClassTable& classes);

  /// Starts again from one hypothesis, in surroundings that an earlier map may show.
  void restart(std::vector<TrackedLandmarkPtr> landmarks, EarlierMap earlier_map = {});

  /// Grows every leaf by its likely assignments, weighs, merges, drops and resamples.
  void step(const TreeInput& input, Rng& rng);

  /// The leaves; the first is the most likely one. Never empty.
  const std::vector<MapHypothesis>& leaves() const { return leaves_; }

  /// What is known of the probability of detection; learns from finished submaps.
  DetectionRate& detectionRate() { return tracking_.detectionRate(); }

  /// How the detector confuses classes; learns from finished submaps.
  ClassConfusion& confusion() { return model_.confusion(); }

  /// Where the submap lies in the earlier map.
  const MapBranching& mapBranching() const { return branching_; }

  /// The leaves and all that was learned (see `StateArchive`).
  void transfer(StateArchive& archive);

 private:
  void predict(MapHypothesis& hypothesis, const TreeInput& input) const;
  void measureFrom(const Pose& T_submap_base, const PoseOffset* offset, const TreeInput& input,
                   std::vector<Measurement>& measurements) const;
  PoseOffset offsetAfter(const MapHypothesis& parent, const TreeInput& input, const AssignmentList& assignments,
                         int choice) const;
  struct Growth;
  void expand(MapHypothesis& parent, const TreeInput& input, std::vector<MapHypothesis>& children);
  MapHypothesis makeChild(const MapHypothesis& parent, const TreeInput& input, const AssignmentList& assignments,
                          int choice);
  void assign(int measurement, int column, const MapHypothesis& parent, const TreeInput& input, Growth& growth) const;
  int splitOf(const MapHypothesis& parent, int measurement, const std::vector<char>& is_seen) const;

  MapperConfig config_;
  AssociationModel model_;
  LandmarkTracking tracking_;
  MapBranching branching_;
  int class_count_;
  KBestSolver solver_;
  AssociationProblem problem_;
  std::vector<Measurement> measurements_;  ///< submap frame, predicted pose, with the pose's uncertainty
  std::vector<Measurement> corrected_;     ///< submap frame, corrected pose
  std::vector<MapHypothesis> leaves_;
  std::uint64_t next_hypothesis_id_ = 1;
};

}  // namespace semantic_mht_slam
