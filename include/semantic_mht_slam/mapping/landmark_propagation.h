#pragma once

#include <vector>

#include "semantic_mht_slam/common/pose.h"
#include "semantic_mht_slam/map/landmark.h"
#include "semantic_mht_slam/mapping/hypothesis.h"
#include "semantic_mht_slam/mapping/mapper_config.h"

namespace semantic_mht_slam {

class StateArchive;

/// Brings landmarks from submap to submap while the vehicle is near (paper, section II: propagation of the first
/// moment). Those that a submap cannot see rest meanwhile, outside its hypotheses, which so have less to go through.
class LandmarkPropagation {
 public:
  explicit LandmarkPropagation(const MapperConfig& config);

  /// A submap ends with these landmarks (its frame, by rising id), of which those go on that were seen within
  /// `propagation`. `best` is its likeliest hypothesis.
  void endSubmap(SubmapId submap, const Pose& T_odom_submap, const std::vector<MixtureLandmark>& landmarks,
                 const MapHypothesis& best);

  /// A submap begins: the landmarks that it may see, in its frame, by rising id.
  std::vector<HypothesisLandmark> beginSubmap(SubmapId submap, const Pose& T_odom_submap);

  /// Forgets all of them.
  void clear();

  /// Whether it carries a landmark on.
  bool carries(LandmarkId landmark) const;

  /// All that it keeps (see `StateArchive`).
  void transfer(StateArchive& archive);

 private:
  void propagate(const Pose& T_new_old);
  bool isOutOfReach(const TrackedLandmark& landmark, SubmapId submap) const;

  double reach_m_;                             ///< from the beginning of a submap to what is seen from anywhere in it
  std::size_t propagated_submaps_;             ///< for how many submaps a landmark goes on without being seen
  std::vector<HypothesisLandmark> landmarks_;  ///< that go on, in the frame of the submap that ended last, by id
  std::vector<HypothesisLandmark> resting_;    ///< those that the present submap cannot see, its frame, by id
  Pose T_odom_last_;                           ///< of the submap that ended last
  PoseOffset last_offset_;                     ///< of the odometry at its end
};

}  // namespace semantic_mht_slam
