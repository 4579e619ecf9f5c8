#pragma once

#include <map>
#include <utility>
#include <vector>

#include "semantic_mht_slam/common/config.h"
#include "semantic_mht_slam/map/landmark.h"
#include "semantic_mht_slam/map/scene.h"

namespace semantic_mht_slam {

/// How near landmarks must be to belong together.
struct CovisibilityConfig {
  double distance_scale_m = 10.0;  ///< standard deviation of the distance kernel
};

void describe(CovisibilityConfig& config, Fields& fields);

/// Weight of two things by their distance, exp(-d^2 / (2 s^2)), in [0, 1].
double distanceKernel(double distance_m, const CovisibilityConfig& config);

/// Which landmarks are seen together, how often and how near to each other (the spatial relationship of paper section
/// III-B): a weighted graph over landmarks.
///
/// The weight of an edge is the share of the keyframes with both landmarks among those with either, times the distance
/// kernel at their mean distance; it is in [0, 1] whatever the number of keyframes. Memory and time of a keyframe grow
/// with the square of its landmarks.
class CovisibilityGraph {
 public:
  explicit CovisibilityGraph(const CovisibilityConfig& config) : config_(config) {}

  /// Counts the landmarks of a keyframe as seen together. Objects that are no landmarks (kNoLandmark) are passed over,
  /// a landmark that is there twice counts once.
  void addKeyframe(const Scene& seen);

  /// How many keyframes saw a landmark.
  int timesSeen(LandmarkId landmark) const;

  /// How many keyframes saw both landmarks; 0 for a landmark and itself.
  int timesSeenTogether(LandmarkId a, LandmarkId b) const;

  /// Weight of the edge between two landmarks; 0 if they were never seen together.
  double weight(LandmarkId a, LandmarkId b) const;

  /// Landmarks with at least `min_weight` to `landmark`, by rising id.
  std::vector<LandmarkId> neighbours(LandmarkId landmark, double min_weight) const;

  /// The scene of a keyframe: what it saw of the map, and the landmarks that it missed although they have an edge of at
  /// least `min_weight` to half or more of those it saw. `nearby` holds the landmarks of the map in the keyframe's base
  /// frame; what it lacks is left out.
  Scene sceneOf(const Scene& seen, const Scene& nearby, double min_weight) const;

 private:
  struct Edge {
    int together = 0;
    double distance_sum_m = 0.0;
  };

  double weightOf(LandmarkId a, LandmarkId b, const Edge& edge) const;

  CovisibilityConfig config_;
  std::map<LandmarkId, int> seen_;
  std::map<LandmarkId, std::map<LandmarkId, Edge>> edges_;  // both ways
};

}  // namespace semantic_mht_slam
