#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "semantic_mht_slam/common/stamped_pose.h"
#include "semantic_mht_slam/map/map.h"
#include "semantic_mht_slam/slam/map_uncertainty.h"
#include "semantic_mht_slam/slam/trajectory_record.h"

namespace semantic_mht_slam {

class StateArchive;

/// A stretch of one odometry, and whether its place in the map was ever known.
struct SessionSummary {
  Stamp begin = 0;
  bool is_located = false;
};

/// The odometry of all drives, and where the vehicle was found in the map without being mapped. A session is a stretch
/// of one odometry.
class Sessions {
 public:
  /// A sample T_odom_base of the present session. One that only says that the vehicle still stands where the newest
  /// ones have it takes the place of the newest.
  void add(const StampedPose& T_odom_base, bool is_standing = false);

  /// Another odometry begins; `next` is the keyframe that the map gets next.
  void begin(KeyframeId next);

  /// Whether a session begins with a keyframe, or before it since the one before.
  bool beginsAt(KeyframeId keyframe) const;

  /// A pose found by localization.
  void add(const MapFix& fix) { sessions_.back().fixes.push_back(fix); }

  /// The sessions of another map behind these; its keyframes are numbered from `first` on, and its poses moved by
  /// `T_map_other`.
  void append(const Sessions& other, KeyframeId first,
              const std::function<Pose(const Pose& T_other_base)>& T_map_other);

  /// The newest sample of the present session; empty before the first.
  std::optional<StampedPose> latestOdometry() const;

  /// The newest fix of the present session; null without any.
  const MapFix* latestFix() const;

  /// The samples of all sessions; of a long stand-still the beginning and the end.
  const std::vector<StampedPose>& odometry() const { return odometry_; }

  /// The samples of the present session behind a stamp.
  std::vector<StampedPose> odometryAfter(Stamp stamp) const;

  /// The odometry of the present session at a stamp, interpolated; empty outside of it, and in a gap longer than
  /// `max_gap_s` in which the vehicle moved.
  std::optional<Pose> odometryAt(Stamp stamp, double max_gap_s) const;

  /// True if the keyframe is of the present session, and no fix of it is newer.
  bool isNewestFix(const Map& map, KeyframeId keyframe) const;

  /// What the trajectory is put together from: odometry, keyframes and fixes; keyframes with their uncertainty if it is
  /// given.
  TrajectoryRecord record(const Map& map, const MapUncertainty& uncertainty = {}) const;

  std::size_t count() const { return sessions_.size(); }

  /// All sessions that have odometry.
  std::vector<SessionSummary> summary(const Map& map) const;

  void transfer(StateArchive& archive);

  /// Whether the keyframes that sessions begin with are those of a map, in their order.
  bool fits(const Map& map) const;

 private:
  struct Session {
    std::size_t first_odometry = 0;
    KeyframeId first_keyframe{0};
    std::vector<MapFix> fixes;

    void transfer(StateArchive& archive);
  };

  std::vector<StampedPose> odometry_;
  std::vector<Session> sessions_{1};
};

}  // namespace semantic_mht_slam
