#pragma once

#include <optional>
#include <vector>

#include "semantic_mht_slam/common/config.h"
#include "semantic_mht_slam/common/stamped_pose.h"
#include "semantic_mht_slam/slam/frame.h"
#include "semantic_mht_slam/slam/frame_assembler.h"

namespace semantic_mht_slam {

/// How the trajectory is estimated.
enum class Method {
  kOdometry,  ///< the odometry as it is: the map frame is the odom frame
};

/// Configuration of the estimator.
struct SlamConfig {
  Method method = Method::kOdometry;
  FrameAssemblerConfig input;
};

void describe(SlamConfig& config, Fields& fields);

/// The estimator: odometry and detections in, trajectory out. Single-threaded; the same input gives the same result
/// whatever the order in which odometry and detections arrive.
class Slam {
 public:
  explicit Slam(const SlamConfig& config);

  /// One odometry sample T_odom_base. Bad ones are dropped and counted; true if it was used.
  bool addOdometry(const StampedPose& T_odom_base);

  /// What the detector saw at `stamp`, in the base frame. Bad ones are dropped and counted.
  void addDetections(Stamp stamp, Detections detections);

  /// Correction of the odometry: T_map_base = T_map_odom * T_odom_base.
  Pose T_map_odom() const { return Pose::identity(); }

  /// T_map_base at every odometry sample that was used, in the order of time.
  std::vector<StampedPose> trajectory() const;

  /// T_map_base at the newest odometry sample; empty before the first.
  std::optional<StampedPose> latestPose() const;

  /// The newest frame that found its odometry; empty before the first.
  const std::optional<Frame>& latestFrame() const { return latest_frame_; }

  const InputCounters& counters() const { return assembler_.counters(); }

 private:
  void processReadyFrames();

  FrameAssembler assembler_;
  std::vector<StampedPose> odometry_;
  std::optional<Frame> latest_frame_;
};

}  // namespace semantic_mht_slam
