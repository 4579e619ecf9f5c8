#include "semantic_mht_slam/app/offline_runner.h"

#include <chrono>

#include "semantic_mht_slam/common/error.h"

namespace semantic_mht_slam {
namespace {

using Clock = std::chrono::steady_clock;

double millisecondsSince(Clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

}  // namespace

RunResult runOffline(const Recording& recording, const SlamConfig& config, const ProgressCallback& progress) {
  RunResult result;
  Slam slam(config);
  const auto begin = Clock::now();
  auto frame = recording.detector_frames.begin();
  for (std::size_t i = 0; i < recording.odometry.size(); ++i) {
    const auto step_begin = Clock::now();
    slam.addOdometry(recording.odometry[i]);
    while (frame != recording.detector_frames.end() && frame->stamp <= recording.odometry[i].stamp) {
      slam.addDetections(frame->stamp, frame->detections);
      ++frame;
    }
    result.step_ms.push_back(millisecondsSince(step_begin));
    progress(i + 1, recording.odometry.size());
  }
  for (; frame != recording.detector_frames.end(); ++frame) slam.addDetections(frame->stamp, frame->detections);
  result.seconds = millisecondsSince(begin) / 1e3;
  result.trajectory = slam.trajectory();
  result.counters = slam.counters();
  if (result.trajectory.empty()) throw InputError("no odometry sample could be used");
  return result;
}

}  // namespace semantic_mht_slam
