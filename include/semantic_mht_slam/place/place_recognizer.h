#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "semantic_mht_slam/common/pose.h"
#include "semantic_mht_slam/map/landmark.h"
#include "semantic_mht_slam/models/class_table.h"
#include "semantic_mht_slam/place/keyframe.h"
#include "semantic_mht_slam/place/pair_descriptor.h"
#include "semantic_mht_slam/place/place_config.h"
#include "semantic_mht_slam/place/planar_scene.h"

namespace semantic_mht_slam {

/// Why a candidate was refused, in the order of the checks.
enum class PlaceRefusal {
  kNone,            ///< accepted
  kUnlikePlace,     ///< the descriptors have too little in common
  kNoAlignment,     ///< no rigid motion brings objects onto each other
  kFewInliers,      ///< too few objects lie on each other
  kFewClasses,      ///< objects of a single class
  kOnALine,         ///< the objects stand in one row
  kUncertain,       ///< the covariance leaves the pose open
  kLowScore,        ///< too small a part of the scenes lies on each other
  kAmbiguous,       ///< another alignment of the same two scenes is nearly as good
  kOutsideGate,     ///< the pose found is further from the present estimate than drift explains
  kRivalPlace,      ///< another place fits nearly as well
  kUnsupported,     ///< not enough alone, and no neighbouring keyframe agrees
  kBetterCandidate  ///< right, but another keyframe of the place fits better
};

/// One line for people; empty for kNone.
std::string reasonText(PlaceRefusal refusal);

/// A candidate for a revisit, with all that is known of it.
struct PlaceMatch {
  std::size_t query = 0;  ///< number of the keyframe, in the order in which they were added
  std::size_t match = 0;  ///< the same of the earlier one
  bool accepted = false;
  PlaceRefusal refusal = PlaceRefusal::kNone;
  Pose T_match_query;
  /// Of T_match_query: order translation (m), rotation (rad), in the frame of the query, a small step on the right.
  Eigen::Matrix<double, 6, 6> cov = Eigen::Matrix<double, 6, 6>::Zero();
  int inliers = 0;
  double static_inliers = 0.0;
  double histogram_divergence = -1.0;  ///< unknown to this chain
  double descriptor_score = -1.0;      ///< in [0, 1]
  double topology_score = -2.0;        ///< unknown to this chain
  double scene_score = -1.0;           ///< share of the smaller scene that lies on the other, in [0, 1]; -1: unknown
  double loop_prob = -1.0;             ///< unknown to this chain
  double verification_score = -1.0;    ///< squared soft inliers over the size of the smaller scene; -1: unknown
  double rival_score = -1.0;           ///< the same of the next distinct alignment of the two scenes; -1: there is none
  double log_evidence = 0.0;           ///< of "same place" over chance
  std::vector<std::pair<LandmarkId, LandmarkId>> pairs;  ///< landmark of the query, landmark of the match
};

/// Finds earlier keyframes that show the place of a new one, and the rigid transform between them; a doubtful one is
/// refused. Deterministic.
///
/// For each keyframe: earlier keyframes inside the drift gate, nearest first and at most `max_compared`; of these the
/// `max_candidates` most alike by descriptor; each is aligned and checked without use of the estimated poses. What
/// passes is accepted if it scores `lone_score`, or scores `supported_score` and agrees with the match of a
/// neighbouring keyframe; a match that contradicts a rival of nearly its score is refused.
class PlaceRecognizer {
 public:
  PlaceRecognizer(const PlaceConfig& config, const ClassTable& classes);

  /// Searches the keyframes of a finished submap among those of earlier submaps, then adds them. `T_map_keyframe` are
  /// the present estimates of all keyframes so far, the new ones at the end. Returns a record of every candidate that
  /// was compared in detail, by query and falling score; at most one a keyframe is accepted.
  /// Throws std::invalid_argument for a wrong number of poses and keyframes that go back in distance or submap.
  std::vector<PlaceMatch> process(std::vector<Keyframe> keyframes, const std::vector<Pose>& T_map_keyframe);

  /// Where a scene is among all keyframes, without any prior: its descriptor is compared with that of every keyframe.
  /// Candidates by falling score, `query` being the number of keyframes; the first is accepted if it stands alone.
  std::vector<PlaceMatch> locate(const Scene& scene, const std::vector<Pose>& T_map_keyframe) const;

  std::size_t keyframes() const { return places_.size(); }

  /// Without their scenes.
  const Keyframe& keyframe(std::size_t index) const { return places_.at(index).keyframe; }

 private:
  struct Place {
    Keyframe keyframe;
    PlanarScene scene;
    PairDescriptor descriptor;
  };

  Place makePlace(Keyframe keyframe) const;
  void add(std::vector<Keyframe> keyframes, std::size_t poses);
  std::vector<std::size_t> gated(std::size_t query, std::size_t earlier, const std::vector<Pose>& T_map_keyframe) const;
  double drift(std::size_t query, std::size_t match) const;
  std::vector<PlaceMatch> compare(const Place& query, std::size_t query_index,
                                  const std::vector<std::size_t>& places) const;
  PlaceMatch verify(const Place& query, std::size_t match) const;
  /// How far the pose found is from the present estimate, as a share of the gate there.
  double gateShare(const PlaceMatch& match, const std::vector<Pose>& T_map_keyframe) const;
  bool isEnough(const PlaceMatch& match, const std::vector<Pose>& T_map_keyframe) const;
  void refuseOutsideGate(std::vector<PlaceMatch>& matches, const std::vector<Pose>& T_map_keyframe) const;
  void refuseRivals(std::vector<PlaceMatch>& matches, const std::vector<Pose>& T_map_keyframe) const;
  bool agree(const PlaceMatch& a, const PlaceMatch& b, const std::vector<Pose>& T_map_keyframe) const;
  bool isSupported(const PlaceMatch& match, const std::vector<PlaceMatch>& others,
                   const std::vector<Pose>& T_map_keyframe) const;

  PlaceConfig config_;
  ClassTable classes_;
  std::vector<Place> places_;
  std::vector<PlaceMatch> recent_;  ///< the best candidate of each of the last keyframes, if it passed the checks
};

}  // namespace semantic_mht_slam
