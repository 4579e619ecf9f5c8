#include "semantic_mht_slam/app/offline_runner.h"

#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/common/stopwatch.h"

namespace semantic_mht_slam {
namespace {

std::vector<LoopClosureResult> loopClosures(const Map& map) {
  std::vector<LoopClosureResult> result;
  for (const LoopClosureRecord& record : map.closures()) {
    result.push_back(
        {map.keyframes()[record.query_keyframe].frame, map.keyframes()[record.match_keyframe].frame, record});
  }
  return result;
}

std::vector<SubmapResult> submapResults(const Map& map, const LoopCloser& closer) {
  std::vector<SubmapResult> results;
  for (const SubmapId submap : map.submaps().ids()) {
    results.push_back({map.keyframes()[map.keyframesOf(submap).front()].frame, closer.checks()[submap]});
  }
  return results;
}

/// Whether the frame came before the sample after number `i`.
bool isDue(const DetectorFrame& frame, std::size_t i, const Recording& recording) {
  if (frame.odometry_before) return *frame.odometry_before <= i + 1;
  return frame.stamp <= recording.odometry[i].stamp;
}

/// What was kept of the drive of a run, at every sample that was used: one of a long stand-still that was not kept is
/// where the next one is. `known` were kept before.
void noteTrajectory(const Slam& slam, const MapUncertainty& uncertainty, const std::vector<StampedPose>& known,
                    RunResult& result) {
  result.whole_trajectory = trajectoryOf(slam);
  const std::vector<FixedAxesCov> cov = trajectoryCovOf(slam, uncertainty);
  std::size_t i = known.size();
  const bool stood_on = i > 0 && result.whole_trajectory[i - 1].stamp != known.back().stamp;
  if (stood_on) --i;
  for (const StampedPose& sample : result.online_trajectory) {
    while (result.whole_trajectory[i].stamp < sample.stamp) ++i;  // a sample that was used later than it came
    result.trajectory.push_back({sample.stamp, result.whole_trajectory[i].T_world_base});
    result.trajectory_cov.push_back(cov[i]);
    if (sample.stamp == result.whole_trajectory[i].stamp) ++i;
  }
}

/// Throws InputError with the causes if nothing of the recording could be used.
void requireUsed(const Recording& recording, const RunResult& result, Method method) {
  const InputCounters& counters = result.counters;
  const bool has_objects =
      counters.detections > 0 || (counters.detections_invalid == 0 && counters.detections_at_origin == 0 &&
                                  recording.refused.unknown_classes.empty());
  const bool is_mapped = method == Method::kOdometry || (counters.frames > 0 && has_objects);
  if (!result.trajectory.empty() && is_mapped) return;
  std::string problem = result.trajectory.empty() ? "no odometry sample could be used" : "no objects could be used";
  for (const std::string& line : droppedInput(counters, recording.refused, recording.names)) problem += "; " + line;
  if (!recording.refused.unknown_classes.empty()) {
    problem +=
        "; fix: give the class table of this detector, --set class_table=FILE (in slam.launch: class_table:=FILE)";
  }
  throw InputError(problem);
}

}  // namespace

RunResult runOffline(const Recording& recording, const SlamConfig& config, const ClassTable& classes,
                     const ProgressCallback& progress, const SlamState* start) {
  RunResult result;
  Slam slam = start == nullptr ? Slam(config, classes) : Slam(config, classes, *start);
  const std::vector<StampedPose> known = trajectoryOf(slam);
  const InputCounters counted = slam.parts().assembler.counters();
  const GnssCounters counted_fixes = slam.parts().fixes.counters();
  const bool is_another_drive = start != nullptr && slam.parts().sessions.latestOdometry() &&
                                !recording.odometry.empty() && !goesOn(slam, recording.odometry.front());
  if (is_another_drive) slam.beginSession();
  const Stopwatch watch;
  auto frame = recording.detector_frames.begin();
  auto fix = recording.fixes.begin();
  for (std::size_t i = 0; i < recording.odometry.size(); ++i) {
    const Stopwatch step_watch;
    const double mapping_before_s = slam.parts().mapping_s;
    const std::optional<StampedPose> waits = slam.parts().unconfirmed;
    for (; fix != recording.fixes.end() && fix->stamp <= recording.odometry[i].stamp; ++fix) slam.addFix(*fix);
    const std::size_t outliers = slam.parts().assembler.counters().odometry_outliers;
    const bool is_used = slam.addOdometry(recording.odometry[i]);
    if (is_used && waits && slam.parts().assembler.counters().odometry_outliers == outliers) {
      // It begins the session, and has its row; where it is, nobody knew.
      result.online_trajectory.push_back({waits->stamp, slam.T_map_odom() * waits->T_world_base});
      result.online_trajectory_cov.push_back(unknownPoseCov());
    }
    while (frame != recording.detector_frames.end() && isDue(*frame, i, recording)) {
      slam.addDetections(frame->stamp, frame->detections);
      ++frame;
    }
    result.step_ms.push_back(step_watch.elapsed_ms());
    result.mapping_ms.push_back(1e3 * (slam.parts().mapping_s - mapping_before_s));
    if (is_used) {
      result.online_trajectory.push_back(*latestPoseOf(slam));
      result.online_trajectory_cov.push_back(latestCovOf(slam).value_or(unknownPoseCov()));
    }
    result.hypotheses.push_back(static_cast<int>(hypothesesOf(slam).size()));
    progress(i + 1, recording.odometry.size());
  }
  for (; frame != recording.detector_frames.end(); ++frame) slam.addDetections(frame->stamp, frame->detections);
  for (; fix != recording.fixes.end(); ++fix) slam.addFix(*fix);
  slam.finish();
  const MapUncertainty uncertainty = uncertaintyOf(slam);
  result.seconds = watch.elapsed_s();
  noteTrajectory(slam, uncertainty, known, result);
  result.state = slam.snapshot();
  result.sessions = slam.parts().sessions.summary(slam.map());
  result.detector_range_m = slam.parts().range_factor * Length::kReferenceRange_m;
  if (slam.parts().mapper) {
    result.odometry_model = slam.parts().mapper->odometryModel();
    result.moving = slam.parts().mapper->movingCounts();
  }
  result.counters = slam.parts().assembler.counters() - counted;
  result.counters.frames_waiting_too_long += slam.parts().assembler.waiting();  // nothing comes any more
  result.counters.odometry_outliers += slam.parts().unconfirmed ? 1 : 0;
  result.fixes = slam.parts().fixes.counters() - counted_fixes;
  result.geo_reference = geoReferenceOf(slam);
  result.landmarks = landmarksOf(slam, uncertainty);
  result.loop_closures = loopClosures(slam.map());
  if (slam.parts().closer) result.submap_checks = submapResults(slam.map(), *slam.parts().closer);
  result.identity = slam.map().identity().ledger();
  result.graph = slam.parts().graph.status();
  result.associations = slam.map().associations();
  result.submaps = slam.map().submaps().size();
  requireUsed(recording, result, config.method);
  return result;
}

}  // namespace semantic_mht_slam
