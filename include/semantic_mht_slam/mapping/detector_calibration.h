#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <vector>

#include "semantic_mht_slam/common/config.h"
#include "semantic_mht_slam/common/pose.h"
#include "semantic_mht_slam/models/class_table.h"
#include "semantic_mht_slam/models/detection.h"

namespace semantic_mht_slam {

class StateArchive;

/// How the detector's noise is found out while driving.
struct CalibrationConfig {
  bool enabled = true;
  int prior_samples = 60;
  int lag_frames = 10;
  Length max_distance_m{4.0};
  double min_stddev_m = 0.03;
  double min_share = 0.1;
};

void describe(CalibrationConfig& config, Fields& fields);

/// Running median of positive numbers: a histogram with logarithmic bins, 5 % wide, which forgets nothing.
class RunningMedian {
 public:
  void add(double value, int count = 1);
  double median() const;
  int count() const { return count_; }

  /// All that was added (see `StateArchive`).
  void transfer(StateArchive& archive);

 private:
  static constexpr int kBins = 200;
  void moveToMedian();

  std::array<int, kBins> bins_{};
  int count_ = 0;
  int median_bin_ = 0;
  int below_ = 0;  ///< values in the bins below that of the median
};

/// Noise of a detector's centroids, estimated from consecutive frames without knowing which object is which: residuals
/// of mutual nearest neighbours of one class after the odometry's motion between the frames. Their medians survive the
/// neighbours that are wrong. Residuals over one frame give the white noise along the line of sight, across it and
/// vertically, by class and range; what is added over several frames gives how fast a centroid wanders with the
/// viewpoint. A detector that hardly ever shows an object in two consecutive frames has only wrong neighbours there,
/// and teaches nothing. Begins with the class table's values as if they had been measured a number of times.
class DetectorCalibration {
 public:
  DetectorCalibration(const CalibrationConfig& config, const ClassTable& classes);

  /// Takes the detections of the next frame, base frame.
  void add(const Pose& T_odom_base, const Detections& detections);

  /// The next frame has nothing to do with those before.
  void forgetFrames() { past_.clear(); }

  /// Standard deviations along the line of sight, across it and vertically, metres.
  Eigen::Vector3d noiseStddev(ClassIndex class_index, double range_m) const;

  static constexpr int kRangeBins = 3;

  /// The noise is the same at all ranges of a bin, 0 to kRangeBins - 1.
  static int rangeBin(double range_m);

  /// Growth of a centroid's variance with the distance driven, m^2/m.
  double wanderVariancePerMetre(ClassIndex class_index) const;

  /// All that it has learned (see `StateArchive`).
  void transfer(StateArchive& archive);

 private:
  struct PastFrame {
    Pose T_odom_base;
    std::vector<Eigen::Vector3d> positions_m;
    std::vector<ClassIndex> classes;

    void transfer(StateArchive& archive);
  };
  struct ClassStatistics {
    std::array<std::array<RunningMedian, 3>, kRangeBins> noise;  ///< by range, then direction
    RunningMedian wander;                                        ///< horizontal, over `lag_frames`
    RunningMedian wander_distance_m;

    void transfer(StateArchive& archive);
  };

  /// An object of a frame and its mutual nearest neighbour in an earlier one.
  struct Neighbours {
    ClassIndex class_index;
    Eigen::Vector3d position_m;  ///< now, base frame
    Eigen::Vector3d residual_m;  ///< now less then
  };

  std::vector<Neighbours> neighbours(const PastFrame& past, const PastFrame& now) const;
  void learnNoise(const PastFrame& past, const PastFrame& now);
  void learnWander(const PastFrame& past, const PastFrame& now);
  std::vector<double> reaches() const;

  CalibrationConfig config_;
  std::vector<ClassStatistics> statistics_;
  std::deque<PastFrame> past_;
  std::uint64_t detections_ = 0;
  std::uint64_t neighbours_ = 0;  ///< of them, in the frame before
};

}  // namespace semantic_mht_slam
