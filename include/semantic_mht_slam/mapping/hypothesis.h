#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "semantic_mht_slam/map/landmark.h"
#include "semantic_mht_slam/mapping/class_noise.h"
#include "semantic_mht_slam/mapping/pose_offset.h"
#include "semantic_mht_slam/models/odometry_model.h"

namespace semantic_mht_slam {

/// A detection, in the frame of the submap as the odometry has it or as a hypothesis corrects it.
struct Measurement {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d cov_m2 = Eigen::Matrix3d::Identity();      ///< of the detector; for association also of the pose
  Eigen::Vector3d ray_m = Eigen::Vector3d::UnitX();          ///< from the base, base axes
  Eigen::Vector3d noise_stddev_m = Eigen::Vector3d::Ones();  ///< along the ray, across it, vertically
  Eigen::Quaterniond R_submap_base = Eigen::Quaterniond::Identity();
  Eigen::Matrix3d pose_cov_m2 = Eigen::Matrix3d::Zero();  ///< what the pose's uncertainty has added to `cov_m2`
  ClassIndex class_index = 0;
  int row = 0;
  Eigen::Matrix3d outlier_cov_m2 = Eigen::Matrix3d::Zero();  ///< added if the centroid is far off
  double wander_variance_per_m = 0.0;  ///< growth of a landmark's variance with the distance driven, by class
  LandmarkId id_if_new = kNoLandmark;  ///< the same in every hypothesis that makes a landmark of it
  /// By class of the object that it may show; null: the detector has stated its noise.
  std::shared_ptr<const std::vector<ClassNoise>> noise_of_class;
};

/// One time step for the tree.
struct TreeInput {
  std::size_t frame = 0;
  SubmapId submap;
  double driven_m = 0.0;                  ///< in this submap
  Pose T_submap_last;                     ///< of the frame before, by the odometry
  Pose T_submap_base;                     ///< by the odometry
  OdometryModel odometry;                 ///< how it errs
  std::vector<Measurement> measurements;  ///< base frame, covariance of the detector
};

/// Whether a landmark exists, by the frames that showed it and those that should have.
struct Existence {
  double log_odds = 0.0;         ///< a real object against clutter
  double visible_prob = 1.0;     ///< that it is not hidden, if it exists
  double miss_likelihood = 1.0;  ///< of all frames that did not show it though it is expected
};

/// What one hypothesis knows of one landmark by its detections.
struct TrackedLandmark {
  LandmarkId id = kNoLandmark;
  Gaussian3 position;  ///< submap frame
  ClassProbs class_probs;
  int observations = 0;
  bool is_from_earlier_submap = false;  ///< case (ii): not seen in this submap so far
  SubmapId first_submap;
  SubmapId last_submap;
  double updated_at_m = 0.0;  ///< distance driven in the submap when it was last seen
  int earlier = -1;           ///< the landmark of the earlier map that it is; -1: none known
  bool is_expected = false;   ///< only the earlier map has it so far; its place follows the hypothesis's `map_offset`

  ClassIndex mostLikelyClass() const {
    Eigen::Index best = 0;
    class_probs.maxCoeff(&best);
    return static_cast<ClassIndex>(best);
  }
};

/// What is known of a fused landmark, as a hypothesis holds it.
inline TrackedLandmark trackedFrom(const MixtureLandmark& landmark) {
  TrackedLandmark result;
  result.id = landmark.id;
  result.position = landmark.position;
  result.class_probs = landmark.class_probs;
  result.observations = landmark.observations;
  result.first_submap = landmark.first_submap;
  result.last_submap = landmark.last_submap;
  return result;
}

/// A landmark as one hypothesis has it. What its detections tell is shared between hypotheses until the next one; its
/// existence changes with every frame that does not show it.
struct HypothesisLandmark {
  std::shared_ptr<const TrackedLandmark> tracked;
  Existence existence;

  const TrackedLandmark& operator*() const { return *tracked; }
  const TrackedLandmark* operator->() const { return tracked.get(); }
};

/// The landmark with an id in a list by rising id; null if the list lacks it.
inline const HypothesisLandmark* findLandmark(LandmarkId id, const std::vector<HypothesisLandmark>& landmarks) {
  const auto place =
      std::lower_bound(landmarks.begin(), landmarks.end(), id,
                       [](const HypothesisLandmark& known, LandmarkId wanted) { return known->id < wanted; });
  return place == landmarks.end() || (*place)->id != id ? nullptr : &*place;
}

/// Which landmark each measurement of a frame went to, with the frames before: a list that branches share.
struct AssociationRecord {
  std::shared_ptr<const AssociationRecord> previous;
  std::size_t frame = 0;
  std::vector<LandmarkId> landmark_of_measurement;  ///< kNoLandmark: false positive
  PoseOffset offset;                                ///< of the odometry, after the frame
};

/// A leaf of the hypothesis tree: a map, and the associations that led to it.
struct MapHypothesis {
  std::uint64_t id = 0;         ///< kept while it has one child
  std::uint64_t parent_id = 0;  ///< the hypothesis that it branched from
  std::size_t born_frame = 0;
  double log_weight = 0.0;                    ///< normalised over the leaves
  std::vector<HypothesisLandmark> landmarks;  ///< by rising id
  std::shared_ptr<const AssociationRecord> history;
  int false_positives = 0;  ///< N^0 of the paper
  PoseOffset offset;        ///< of the odometry in this submap
  /// T_earlier_submap: origin and heading of the submap in the predicted frame of the earlier map; empty: "not here
  /// before".
  std::optional<PoseOffset> map_offset;
  int expected_found = 0;        ///< expected landmarks that were seen
  double expected_missed = 0.0;  ///< expected number of those that should have been seen by now and were not
};

/// A copy of all but the landmarks.
inline MapHypothesis withoutLandmarks(const MapHypothesis& hypothesis) {
  const auto& [id, parent_id, born_frame, log_weight, landmarks, history, false_positives, offset, map_offset,
               expected_found, expected_missed] = hypothesis;
  return {id,     parent_id,  born_frame,     log_weight,     {}, history, false_positives,
          offset, map_offset, expected_found, expected_missed};
}

}  // namespace semantic_mht_slam
