#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "semantic_mht_slam/app/offline_runner.h"
#include "semantic_mht_slam/app/recording.h"
#include "semantic_mht_slam/app/system_config.h"
#include "semantic_mht_slam/evaluation/trajectory_error.h"

namespace semantic_mht_slam {

/// Error of a run's trajectory against the recording's ground truth, over the odometry samples whose stamp the ground
/// truth has; camera 0 if its place is known, as KITTI scores it, else the base frame. Empty without ground truth.
std::optional<TrajectoryError> scoreRun(const Recording& recording, const std::vector<StampedPose>& trajectory);

/// Writes trajectory.txt, trajectory.tum, both with their covariances beside them, loop_closures.csv, submaps.csv,
/// landmarks.csv, associations.csv and config.yaml to `folder`, which must exist.
void writeResultFiles(const std::string& folder, const Recording& recording, const RunResult& result,
                      const SystemConfig& config, const ClassTable& classes);

/// Writes report.json, with what was dropped of the input by cause; `map_bytes` is the size of the map file, `error`
/// that of `scoreRun`. Only `seconds`, `ms_per_frame`, `mapping_ms_per_frame` and `peak_rss_mb` differ between two runs
/// with the same input.
void writeReport(const std::string& folder, const Recording& recording, const RunResult& result,
                 const std::optional<TrajectoryError>& error, const SystemConfig& config, std::size_t map_bytes);

}  // namespace semantic_mht_slam
