#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "semantic_mht_slam/common/pose.h"
#include "semantic_mht_slam/map/keyframe.h"
#include "semantic_mht_slam/models/class_table.h"
#include "semantic_mht_slam/place/class_histogram.h"
#include "semantic_mht_slam/place/pair_descriptor.h"
#include "semantic_mht_slam/place/paper_chain.h"
#include "semantic_mht_slam/place/place_config.h"
#include "semantic_mht_slam/place/place_match.h"
#include "semantic_mht_slam/registration/registration_config.h"

namespace semantic_mht_slam {

class StateArchive;

/// What a finished submap is besides its keyframes.
struct SubmapSummary {
  ClassHistogram histogram;  ///< of its landmarks; used by the paper's chain alone
  bool is_checked = true;    ///< false: its keyframes are only taken in, to be found later
};

/// The places of a finished submap, as they were taken in.
struct PlacesOfSubmap {
  ClassHistogram histogram;  ///< of its landmarks
  std::vector<Keyframe> keyframes;
};

/// Finds earlier keyframes that show the place of a new one, and the rigid transform between them; a doubtful one is
/// refused. Deterministic.
///
/// For each keyframe of a submap that is checked: earlier keyframes inside the drift gate, nearest first and at most
/// `max_compared`; of these the `max_candidates` most alike by descriptor (or, with the paper's chain, the best that
/// `PaperChain` proposes among all); each is aligned and checked without use of the estimated poses. What passes is
/// accepted if it scores `lone_score`, or scores `supported_score` and agrees with the match of a neighbouring
/// keyframe; a match that contradicts a rival of nearly its score is refused.
class PlaceRecognizer {
 public:
  PlaceRecognizer(const PlaceConfig& config, const ClassTable& classes, const RegistrationConfig& registration = {});

  /// Searches the keyframes of a finished submap among those of earlier submaps, then adds them. `T_map_keyframe` are
  /// the present estimates of all keyframes so far, the new ones at the end. Returns a record of every candidate that
  /// was compared in detail, by query and falling score; at most one a keyframe is accepted.
  /// Throws std::invalid_argument for a wrong number of poses, keyframes that go back in distance or submap and, with
  /// the paper's chain, a histogram of another number of classes.
  std::vector<PlaceMatch> process(std::vector<Keyframe> keyframes, const std::vector<Pose>& T_map_keyframe,
                                  const SubmapSummary& submap = {});

  /// The keyframes most like a scene by descriptor, wherever they are, the most alike first: at most `max_candidates`,
  /// none below `min_descriptor_score`.
  std::vector<std::size_t> mostAlike(const Scene& scene) const;

  /// The state without the keyframes, which are given as they were added (with their scenes): into an empty recogniser,
  /// or out of one (see `StateArchive`).
  void transfer(StateArchive& archive, std::vector<PlacesOfSubmap> submaps);

  std::size_t keyframes() const { return places_.size(); }

  const Keyframe& keyframe(std::size_t index) const { return places_.at(index).keyframe; }

 private:
  struct Place {
    Keyframe keyframe;
    PairDescriptor descriptor;
  };

  using Ranking =
      std::vector<std::pair<double, std::size_t>>;  ///< likeness, negative, and number of a place; best first

  Ranking mostAlike(const Place& query, const std::vector<std::size_t>& places) const;
  Place makePlace(Keyframe keyframe) const;
  void add(std::vector<Keyframe> keyframes, std::size_t poses);
  std::vector<std::size_t> gated(std::size_t query, std::size_t earlier, const std::vector<Pose>& T_map_keyframe) const;
  double drift(std::size_t query, std::size_t match) const;
  std::vector<PlaceMatch> compare(const Place& query, std::size_t query_index,
                                  const std::vector<std::size_t>& places) const;
  std::vector<PlaceMatch> comparePaper(const Keyframe& query, std::size_t query_index,
                                       const ClassHistogram& submap_histogram);
  std::vector<PlaceMatch> decide(std::vector<std::vector<PlaceMatch>> of_queries,
                                 const std::vector<Pose>& T_map_keyframe);
  void forgetOldMatches();
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
  RegistrationConfig registration_;
  std::vector<Place> places_;
  std::optional<PaperChain> paper_;
  std::vector<PlaceMatch> recent_;  ///< the best candidate of each of the last keyframes, if it passed the checks
};

}  // namespace semantic_mht_slam
