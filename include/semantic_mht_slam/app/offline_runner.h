#pragma once

#include <functional>
#include <vector>

#include "semantic_mht_slam/app/recording.h"
#include "semantic_mht_slam/slam/slam.h"

namespace semantic_mht_slam {

/// A loop closure between two frames of the detector.
struct LoopClosureResult {
  std::size_t query_frame = 0;
  std::size_t match_frame = 0;
  LoopClosureRecord record;
};

/// A finished submap as a source of loop closures.
struct SubmapResult {
  std::size_t first_frame = 0;  ///< of the detector
  SubmapCheck check;
};

/// What a run over a recording gave.
struct RunResult {
  std::vector<StampedPose> trajectory;         ///< T_map_base at every odometry sample of the recording that was used
  std::vector<StampedPose> online_trajectory;  ///< T_map_base as it was known at each of these moments
  std::vector<FixedAxesCov> trajectory_cov;    ///< of each pose of `trajectory`
  std::vector<FixedAxesCov> online_trajectory_cov;  ///< the same as it was known live
  std::vector<LoopClosureResult> loop_closures;
  InputCounters counters;  ///< of the recording alone
  GraphStatus graph;
  std::vector<IdentityEvent> identity;             ///< mergers of landmarks, and what was taken back
  std::vector<MixtureLandmark> landmarks;          ///< map frame, by rising id
  std::vector<DetectionAssociation> associations;  ///< of every detection that was used
  std::size_t submaps = 0;
  std::vector<SubmapResult> submap_checks;    ///< of the submaps with frames; none without map
  SlamState state;                            ///< to go on from
  std::vector<StampedPose> whole_trajectory;  ///< with that of the map that the run began with
  std::vector<int> hypotheses;                ///< living ones after each odometry sample
  std::vector<double> step_ms;     ///< wall time of each step: an odometry sample and the detections up to its stamp
  std::vector<double> mapping_ms;  ///< what the mapper took of each: association, hypotheses, fusion; not the back end
  double seconds = 0.0;            ///< wall time of the run, without reading and writing files
  std::vector<SessionSummary> sessions;         ///< of the map that the run began with, too
  double detector_range_m = 0.0;                ///< that all lengths follow which are not set
  MovingCounts moving;                          ///< of the map that the run began with, too
  std::optional<OdometryModel> odometry_model;  ///< as it was learned; none without map
  GnssCounters fixes;                           ///< of the recording alone
  std::optional<GeoReference> geo_reference;    ///< where the map is on the Earth, if fixes determined it
};

/// Called now and then with the number of odometry samples done and of all.
using ProgressCallback = std::function<void(std::size_t, std::size_t)>;

/// Feeds a recording to the estimator in the order in which it came, as fast as it goes.
/// With `start`, goes on from that state (as another session if the odometry does not go on); frames are counted on,
/// too. Throws InputError with the causes if nothing of the odometry or of the objects could be used, or if the state
/// does not fit.
RunResult runOffline(const Recording& recording, const SlamConfig& config, const ClassTable& classes,
                     const ProgressCallback& progress, const SlamState* start = nullptr);

}  // namespace semantic_mht_slam
