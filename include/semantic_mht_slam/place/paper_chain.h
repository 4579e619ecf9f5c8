#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "semantic_mht_slam/common/config.h"
#include "semantic_mht_slam/map/keyframe.h"
#include "semantic_mht_slam/place/class_histogram.h"
#include "semantic_mht_slam/place/covisibility.h"
#include "semantic_mht_slam/place/histogram_index.h"
#include "semantic_mht_slam/place/loop_filter.h"
#include "semantic_mht_slam/place/place_match.h"
#include "semantic_mht_slam/place/scene_score.h"

namespace semantic_mht_slam {

class StateArchive;

/// Parameters of the paper's place recognition.
struct PaperChainConfig {
  int similar_submaps = 20;
  double max_divergence = 0.1;  ///< of submaps, nats
  int scenes_per_submap = 5;
  double max_scene_distance = 0.35;  ///< of scene histograms
  double recent_m = 80.0;            ///< driven since: too young to be a revisit; `PlaceRecognizer` sets its own
  double min_score = 1.45;           ///< of S_ncc + S_scene, in [-1, 2]
  CovisibilityConfig covisibility;
  SceneScoreConfig scene;
  LoopFilterConfig filter;
};

void describe(PaperChainConfig& config, Fields& fields);

/// An earlier keyframe that may show the place of the query, with every score.
struct PaperCandidate {
  std::size_t place = 0;  ///< number of the earlier keyframe, in the order in which they were added
  std::size_t frame = 0;  ///< of the earlier keyframe
  SubmapId submap;        ///< of the earlier keyframe
  double histogram_divergence = -1.0;
  double scene_distance = -1.0;                ///< Euclidean distance of the scene histograms
  double topology_score = -2.0;                ///< S_ncc
  double scene_score = -1.0;                   ///< S_scene; -1: not computed, the sum cannot reach the threshold
  double loop_prob = -1.0;                     ///< of the loop filter, after this query
  PlaceRefusal refusal = PlaceRefusal::kNone;  ///< kNone: proposed for geometric verification

  double score() const { return topology_score + scene_score; }
};

/// Place recognition of paper section III-B up to the geometric verification: similar submaps by the divergence of
/// their class histograms, in each of them the nearest scenes by the distance of theirs, both from kd-trees; the sum of
/// the topology and the landmark score against a threshold; a Bayes filter over consecutive keyframes.
class PaperChain {
 public:
  /// `classes` is the size of the class table. Throws std::invalid_argument as HistogramIndex does.
  PaperChain(const PaperChainConfig& config, int classes);

  /// Takes in a finished submap: the class histogram of its landmarks and its keyframes in the order of the drive.
  void add(const ClassHistogram& submap_histogram, const std::vector<Keyframe>& keyframes);

  /// Candidates for a keyframe whose submap has this histogram, best first, equally good ones by frame. Those driven
  /// less than `recent_m` before it are no candidates; its own submap may have been added, so that the covisibility
  /// graph knows its landmarks. Keyframes must be asked in the order of the drive, as the filter moves on with each,
  /// and with the scene with which they were added.
  std::vector<PaperCandidate> query(const Keyframe& keyframe, const ClassHistogram& submap_histogram);

  /// Forgets the belief of the filter, as after a gap in the drive or for a submap that was not checked.
  void resetFilter() { filter_.reset(); }

  /// What the loop filter believes, which only the order of queries tells (see `StateArchive`).
  void transfer(StateArchive& archive);

 private:
  struct Place {
    std::size_t number = 0;
    std::size_t frame = 0;
    SubmapId submap;
    double driven_m = 0.0;
    Scene scene;
    Eigen::MatrixXd laplacian;
  };
  struct PlacesOfSubmap {
    double begin_m = 0.0;
    std::vector<Place> places;
    HistogramIndex scenes;
  };

  std::vector<PaperCandidate> scoreScenesOf(const PlacesOfSubmap& submap, double divergence, const Keyframe& keyframe,
                                            const Eigen::MatrixXd& laplacian) const;
  PaperCandidate scorePair(const Place& place, const Keyframe& keyframe, const Eigen::MatrixXd& laplacian) const;
  Eigen::MatrixXd laplacianOf(const Scene& scene) const;

  PaperChainConfig config_;
  int classes_;
  CovisibilityGraph graph_;
  HistogramIndex submap_index_;
  std::vector<PlacesOfSubmap> submaps_;
  std::size_t places_ = 0;
  LoopFilter filter_;
};

}  // namespace semantic_mht_slam
