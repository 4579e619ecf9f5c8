#pragma once

#include <deque>
#include <optional>
#include <string>

#include <semantic_mht_slam/SemanticObjectArray.h>

#include "semantic_mht_slam/app/recording.h"
#include "semantic_mht_slam/bags/odometry_gate.h"
#include "semantic_mht_slam/bags/sensor_transforms.h"
#include "semantic_mht_slam/models/class_table.h"

namespace semantic_mht_slam {

/// The way of objects to the estimator, for the node and for bags alike: their stamps, the transform of their sensor,
/// which may come later than they, and their classes. What is refused is counted.
///
/// Objects wait, in their order, for the transform of their sensor, and where they overtook a jump back in time, for
/// the odometry that tells of it. Nothing waits for them. A detector that is merely late does not wait: its stamps
/// rise.
class ObjectsGate {
 public:
  /// At most `most` messages wait; beyond that the oldest is given up.
  ObjectsGate(const NodeConfig& frames, const ClassTable& classes, SensorTransforms& sensors, std::size_t most)
      : classes_(classes), sensors_(sensors), timeout_s_(frames.tf_timeout_s), most_(most) {}

  /// A message has come at the time `now_s`, of any clock that goes on.
  void hold(const SemanticObjectArray& message, const OdometryGate& odometry, double now_s, RefusedInput& refused);

  /// The next detections that are to be used now, in the base frame; empty if there are none. `latest` is the newest
  /// odometry in use.
  std::optional<DetectorFrame> next(const OdometryGate& odometry, const std::optional<Stamp>& latest, double now_s,
                                    RefusedInput& refused);

  /// Frame of the newest objects that were used, if it does not move with the robot; empty otherwise.
  const std::string& fixedFrame() const { return fixed_frame_; }

  /// Gives up what waits.
  void clear(RefusedInput& refused);

 private:
  struct Waiting {
    SemanticObjectArray message;
    bool falls_back = false;  ///< behind the objects before
    double deadline_s = 0.0;
  };

  bool isRefused(const SemanticObjectArray& message, SensorPlace::Answer answer, RefusedInput& refused) const;

  const ClassTable& classes_;
  SensorTransforms& sensors_;
  const double timeout_s_;
  const std::size_t most_;
  std::deque<Waiting> waiting_;
  std::optional<Stamp> newest_;  ///< of those that came
  std::string fixed_frame_;
};

}  // namespace semantic_mht_slam
