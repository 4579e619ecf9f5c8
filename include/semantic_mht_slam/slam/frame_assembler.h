#pragma once

#include <cstddef>
#include <deque>
#include <optional>

#include "semantic_mht_slam/common/config.h"
#include "semantic_mht_slam/common/stamped_pose.h"
#include "semantic_mht_slam/models/frame.h"

namespace semantic_mht_slam {

class StateArchive;

/// How detections find their odometry.
struct FrameAssemblerConfig {
  double max_odometry_gap_s = 1.0;
  double odometry_history_s = 10.0;
  int max_waiting_frames = 1000;
};

void describe(FrameAssemblerConfig& config, Fields& fields);

/// Whether it is a pose, no farther than 1e10 m away, at a time that ROS can write.
bool isUsable(const StampedPose& T_odom_base);

/// What came in and what was dropped, since the beginning.
struct InputCounters {
  std::size_t odometry = 0;                 ///< odometry samples used
  std::size_t odometry_invalid = 0;         ///< dropped: not usable (see `isUsable`)
  std::size_t odometry_not_rising = 0;      ///< dropped: stamp not after the one before
  std::size_t odometry_outliers = 0;        ///< dropped: no motion leads there, and the next sample goes on without it
  std::size_t frames = 0;                   ///< detector frames used
  std::size_t frames_before_odometry = 0;   ///< dropped: older than the odometry that is still known
  std::size_t frames_not_rising = 0;        ///< dropped: stamp not after the frame before, or far ahead of the next one
  std::size_t frames_far_ahead = 0;         ///< dropped: ahead of the odometry by more than its history is long
  std::size_t frames_in_odometry_gap = 0;   ///< dropped: odometry around the stamp is too far apart
  std::size_t frames_waiting_too_long = 0;  ///< dropped: no odometry came for them in time, or in their session
  std::size_t detections = 0;               ///< detections in the frames used
  std::size_t detections_invalid = 0;       ///< dropped: position, covariance, score or size cannot be used
  std::size_t detections_at_origin = 0;     ///< dropped: exactly 0, 0, 0, where a sensor puts what it has no range of
  std::size_t covariances_unknown = 0;      ///< left out, the learned noise is used: negative, zero or beyond the range
  std::size_t frames_standing = 0;          ///< not looked at: from where the vehicle has stood for long
};

/// What was counted since `before`.
InputCounters operator-(InputCounters counters, const InputCounters& before);

/// Joins odometry and detections by their stamps: a frame gets the odometry pose interpolated to its stamp, as soon as
/// odometry at or after that stamp is there. The result depends on stamps alone, not on the order in which the two
/// kinds of input arrive, as long as each kind arrives in its own order.
class FrameAssembler {
 public:
  explicit FrameAssembler(const FrameAssemblerConfig& config);

  /// Returns true if the sample is used.
  bool addOdometry(const StampedPose& T_odom_base);

  /// Unusable detections are dropped one by one; the frame stays, empty if need be.
  void addDetections(Stamp stamp, Detections detections);

  /// The next frame in the order of stamps whose odometry is known; empty if there is none yet.
  std::optional<Frame> next();

  const InputCounters& counters() const { return counters_; }

  /// A frame that it gave was not looked at, as the vehicle stands.
  void countStanding() { ++counters_.frames_standing; }

  /// A sample was not taken, as no motion leads there.
  void countOutlier() { ++counters_.odometry_outliers; }

  /// Another odometry begins at `begin`: forgets the one so far and drops what waits for it; counts go on.
  void beginSession(Stamp begin);

  /// Frames that wait for odometry.
  std::size_t waiting() const { return waiting_.size(); }

  /// Frames are counted from `next` on.
  void countFrom(std::size_t next) { next_index_ = next; }

  /// What waits, the odometry that is kept, and the counters (see `StateArchive`).
  void transfer(StateArchive& archive);

 private:
  struct WaitingFrame {
    std::size_t index = 0;
    Stamp stamp = 0;
    Detections detections;

    void transfer(StateArchive& archive);
  };

  std::optional<Pose> interpolatedOdometry(Stamp stamp);
  void forgetOldOdometry();
  void dropOutlierBefore(Stamp stamp);

  /// Stamp of the newest frame, or empty.
  std::optional<Stamp> newest() const { return waiting_.empty() ? last_taken_ : waiting_.back().stamp; }

  FrameAssemblerConfig config_;
  std::deque<StampedPose> odometry_;
  std::deque<WaitingFrame> waiting_;
  std::size_t next_index_ = 0;
  std::optional<Stamp> last_taken_;  ///< stamp of the newest frame that no longer waits
  InputCounters counters_;
};

}  // namespace semantic_mht_slam
