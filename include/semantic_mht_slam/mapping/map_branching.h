#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "semantic_mht_slam/map/submap.h"
#include "semantic_mht_slam/mapping/earlier_map.h"
#include "semantic_mht_slam/mapping/hypothesis.h"
#include "semantic_mht_slam/models/class_table.h"
#include "semantic_mht_slam/registration/registration.h"

namespace semantic_mht_slam {

class EarlierMapPlacement;
class StateArchive;

/// Log evidence of what a hypothesis expected by the earlier map and found, and of the expected number of what it
/// should have found and did not. The share of the earlier landmarks that can be seen from this pass is not known and
/// common to all (uniform prior): many may be hidden together, or stand in another street.
double logExpectationEvidence(int found, double missed);

/// Branches of a submap's hypotheses over where the submap lies in the earlier map ("shifted by 3 m and 2 degrees",
/// "not here before"). A child with an alignment holds the offset as a Gaussian, knows which of its landmarks the
/// earlier map has, and expects the others: they are case (ii) of the association, at a place that follows the offset.
/// When one is seen, it becomes a landmark of the submap, with the id that it would have as a new one, so that ids
/// agree between branches; the offset learns from it.
class MapBranching {
 public:
  MapBranching(const MapAlignmentConfig& config, const ClassTable& classes, const RegistrationConfig& registration);

  /// A submap begins.
  void restart(EarlierMap map);

  /// If it is time: aligns the landmarks of the likeliest leaf, and makes of every leaf one child for each likely
  /// alignment beside the leaf itself, which stands for "not here before". `leaves` comes with the likeliest first;
  /// weights are to be normalised afterwards. Children whose share of all weight is below exp(`log_min_weight`) are not
  /// made. True if the landmarks fit somewhere.
  bool branch(const TreeInput& input, double log_min_weight, std::uint64_t& next_hypothesis_id,
              std::vector<MapHypothesis>& leaves);

  /// Moves the offset of `leaf`, and the landmarks that it expects, after detections of expected landmarks. `seen` are
  /// indices in the earlier map with the measurement (submap frame, corrected pose) that went there.
  void follow(const std::vector<std::pair<int, const Measurement*>>& seen, MapHypothesis& leaf) const;

  /// The alignment on which most weight agrees, from all landmarks of the submap; empty if no leaf has one. `leaves`
  /// are normalised.
  std::optional<MapAlignment> conclude(const std::vector<MapHypothesis>& leaves) const;

  /// The earlier map of the present submap, and when it is looked at next (see `StateArchive`).
  void transfer(StateArchive& archive);

  /// How many landmarks the earlier map has.
  int earlierLandmarks() const { return static_cast<int>(map_.landmarks.size()); }

 private:
  using Matches = std::map<LandmarkId, int>;  ///< earlier landmark of each landmark of the submap

  std::vector<RegistrationMode> modesOf(const std::vector<const TrackedLandmark*>& landmarks,
                                        const RegistrationPrior& prior, std::vector<LandmarkId>& ids) const;
  Matches matchesOf(const RegistrationMode& mode, const std::vector<LandmarkId>& ids) const;
  MapHypothesis aligned(const MapHypothesis& leaf, const PoseOffset& offset, Matches matches,
                        const TreeInput& input) const;
  void matchTheRest(const MapHypothesis& leaf, const EarlierMapPlacement& placement, Matches& matches) const;
  EarlierMapPlacement placementBy(const PoseOffset& offset) const;
  double agreeingWeight(const std::vector<MapHypothesis>& leaves, const PoseOffset& offset, double log_evidence) const;

  MapAlignmentConfig config_;
  ClassTable classes_;
  RegistrationConfig registration_;
  EarlierMap map_;  ///< landmarks by rising id
  double next_attempt_m_ = 0.0;
  mutable std::vector<int> earlier_of_point_;  ///< of the points that were aligned last
};

}  // namespace semantic_mht_slam
