#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "semantic_mht_slam/common/stamp.h"
#include "semantic_mht_slam/evaluation/category_plot.h"
#include "semantic_mht_slam/evaluation/loop_score.h"
#include "semantic_mht_slam/evaluation/trajectory_error.h"

#include "evaluate_benchmark_cells.h"

namespace semantic_mht_slam {

/// The truth of a sequence.
struct SequenceTruth {
  std::string path;
  std::vector<PoseMatrix> T_world_cam0;
  std::vector<Pose> T_world_velodyne;
  Pose T_cam0_velodyne;
  std::vector<Stamp> stamps;
  double length_m = 0.0;
};

/// Reads poses.txt, calib.txt and times.txt of a sequence's folder. Throws InputError.
SequenceTruth readTruth(const std::string& dataset);

/// Scores results and keeps what several runs share: truths and errors of the odometries as they are.
class BenchmarkScorer {
 public:
  /// Every figure of a run that does not change when it is repeated. Throws InputError if a file of the result is
  /// missing or broken.
  Figures figuresOf(const BenchmarkCell& cell);

  const SequenceTruth& truthOf(const BenchmarkCell& cell);

  /// Error of the odometry that the cell was given.
  const TrajectoryError& odometryError(const BenchmarkCell& cell);

 private:
  std::map<std::string, SequenceTruth> truths_;
  std::map<std::string, TrajectoryError> odometry_errors_;
};

/// Times and memory of a run, which are measured anew each time: seconds, ms_mean, ms_p50, ms_p95, ms_p99, ms_max,
/// mapping_ms_mean, mapping_ms_p99 (the mapper alone), peak_rss_mb.
Figures measuredOf(const BenchmarkCell& cell);

/// How many frames had how many hypotheses; empty if the report does not tell.
Histogram hypothesesOf(const BenchmarkCell& cell);

/// Trajectory of camera 0 that a run ended with.
std::vector<PoseMatrix> readResult(const BenchmarkCell& cell);

/// The trajectory as it was known live, one list entry a sample whose stamp times.txt has.
struct OnlineTrajectory {
  std::vector<double> frames;
  std::vector<PoseMatrix> truth;     ///< T_world_cam0
  std::vector<PoseMatrix> estimate;  ///< T_world_cam0
};

/// trajectory_online.tum of a run; empty if it wrote none. Throws InputError.
OnlineTrajectory readOnline(const BenchmarkCell& cell, const SequenceTruth& truth);

/// A system to compare with: its name and its trajectory of camera 0, from the folder `reference` of the sequence.
std::vector<std::pair<std::string, std::vector<PoseMatrix>>> readReferences(const std::string& dataset,
                                                                            const SequenceTruth& truth);

}  // namespace semantic_mht_slam
