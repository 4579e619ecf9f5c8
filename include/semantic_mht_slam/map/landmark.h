#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "semantic_mht_slam/common/gaussian.h"
#include "semantic_mht_slam/common/pose.h"
#include "semantic_mht_slam/map/ids.h"
#include "semantic_mht_slam/models/class_table.h"

namespace semantic_mht_slam {

/// Stable name of a landmark; 0 is never used. A landmark that several hypotheses made from the same detection has one
/// id.
using LandmarkId = std::uint64_t;
constexpr LandmarkId kNoLandmark = 0;

constexpr int kMaxClasses = 32;

/// Probability of each class of the table; sums to 1. Kept without allocation.
using ClassProbs = Eigen::Array<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMaxClasses, 1>;

/// One Gaussian of a mixture.
struct MixtureComponent {
  double weight = 1.0;  ///< in (0, 1]
  Gaussian3 position;
};

/// Extents of an object, mean of what a detector said of it: along the axes of the base at the time.
struct LandmarkSize {
  Eigen::Vector3d mean_m = Eigen::Vector3d::Zero();
  int detections = 0;  ///< that said it; 0: not known

  void add(const LandmarkSize& other);
};

/// A landmark with all that the hypotheses say of it: the fused result of a hypothesis tree (paper, section III).
struct MixtureLandmark {
  LandmarkId id = kNoLandmark;
  std::vector<MixtureComponent> components;  ///< by falling weight; weights sum to 1
  Gaussian3 position;                        ///< moments of the mixture
  ClassProbs class_probs;
  double existence_prob = 0.0;
  double seen_standing_s = 0.0;  ///< longest time from its first to its last detection in a pass
  int observations = 0;          ///< detections assigned to it in the most likely hypothesis that has it
  SubmapId first_submap;
  SubmapId last_submap;                ///< that saw it
  std::vector<LandmarkId> merged_ids;  ///< other names of it, rising
  LandmarkSize size;                   ///< as its last submap saw it; in a `Map`, as all did
  bool is_locked = false;              ///< a person said that it stays as it is

  ClassIndex mostLikelyClass() const;
  bool isUndecided() const { return components.size() > 1; }
};

/// Where the landmark with an id stands in a list by rising id, or would stand.
std::vector<MixtureLandmark>::const_iterator placeOf(LandmarkId id, const std::vector<MixtureLandmark>& landmarks);

/// The landmark with an id in a list by rising id; null if the list lacks it.
const MixtureLandmark* findLandmark(LandmarkId id, const std::vector<MixtureLandmark>& landmarks);

/// A landmark moved from frame b to frame a.
MixtureLandmark transformed(const Pose& T_a_b, const MixtureLandmark& landmark);

/// Mean and covariance of a mixture. Throws std::invalid_argument for an empty one.
Gaussian3 moments(const std::vector<MixtureComponent>& components);

}  // namespace semantic_mht_slam
