#include "semantic_mht_slam/common/text.h"
#include "semantic_mht_slam/ros/diagnosis.h"

#include "finding.h"

namespace semantic_mht_slam {

using diagnostic_updater::DiagnosticStatusWrapper;

namespace {

constexpr double kLost = 5.0;       // times as far as the detector sees
constexpr std::size_t kBarren = 3;  // finished submaps without a landmark

void findEstimatorFault(const NodeStatus& now, const NodeStatus& before, Finding& finding) {
  const FailureStatus& input = now.input_failures;
  const FailureStatus& others = now.other_failures;
  const std::string report = "keep a bag of the input and report it (docs/troubleshooting.md)";
  finding.error(input.isLasting(), "the estimator failed three times in a row and stands still: " + input.newest,
                "the pose goes on by odometry alone; call reset or load_map, and " + report);
  finding.error(input.count > before.input_failures.count, "an unexpected failure dropped a message: " + input.newest,
                report + "; reset begins anew if it goes on");
  finding.error(others.count > before.other_failures.count, "unexpected failure of " + others.newest, report);
  finding.warn(now.estimator.initial_poses_refused > before.estimator.initial_poses_refused,
               "initialpose is refused: " + now.estimator.initial_pose_problem,
               "set localization by set_mode first, and give a finite pose and covariance in the map frame");
  finding.warn(now.estimator.graph.failures > before.estimator.graph.failures,
               "the pose graph cannot be solved (" + now.estimator.graph.newest_failure + "): the map stays as it was",
               "look for jumps of the odometry and for objects at absurd distances; 'reset' begins a new map");
  finding.warn(now.estimator.lost_m > kLost * now.estimator.far_m,
               "the vehicle has not found itself in the map for " + formatFixed(now.estimator.lost_m, 0) + " m",
               "is it where the map is? say where by initialpose, or call reset for a new map");
  finding.warn(now.estimator.is_lost, "lost: no pose goes out until the vehicle has found itself in the map",
               "drive on where the map was made, or say where it is on initialpose");
  finding.warn(now.estimator.submaps >= kBarren && now.estimator.landmarks == 0,
               "no landmark after " + formatFixed(now.estimator.driven_m, 0) + " m",
               "are static classes seen (class table), and the same objects again and again? see objects");
}

}  // namespace

void diagnoseEstimator(const NodeStatus& now, const NodeStatus& before, DiagnosticStatusWrapper& status) {
  const EstimatorStatus& estimator = now.estimator;
  Finding finding(status);
  findEstimatorFault(now, before, finding);
  finding.otherwise(std::to_string(estimator.hypotheses) + " hypotheses, " + std::to_string(estimator.landmarks) +
                    " landmarks, " + formatFixed(now.frame_times.mean_ms, 1) + " ms a frame");
  status.add("method", estimator.method);
  status.add("mode", estimator.mode);
  status.add("hypotheses", estimator.hypotheses);
  status.add("landmarks", estimator.landmarks);
  status.add("submaps", estimator.submaps);
  status.add("loops", estimator.loops);
  if (estimator.fixes.received > 0) {
    status.add("fixes received", estimator.fixes.received);
    status.add("fixes used for keyframes", estimator.fixes.used);
    status.add("map has its place on the Earth", estimator.is_map_placed ? "yes" : "not yet");
  }
  status.add("failed solutions of the pose graph", estimator.graph.failures);
  status.add("maps begun", estimator.resets + 1);
  status.add("initial poses refused", estimator.initial_poses_refused);
  status.add("unexpected failures of the input", now.input_failures.count);
  status.add("unexpected failures of services and timers", now.other_failures.count);
  status.add("objects dropped while it stands still", estimator.objects_while_failing);
  status.add("objects not used while paused", estimator.objects_while_paused);
  status.add("frame time, mean (ms)", formatFixed(now.frame_times.mean_ms, 3));
  status.add("frame time, p99 (ms)", formatFixed(now.frame_times.p99_ms, 3));
  status.add("frame time, max (ms)", formatFixed(now.frame_times.max_ms, 3));
  status.add("resident memory (MB)", formatFixed(now.resident_mb, 1));
}

}  // namespace semantic_mht_slam
