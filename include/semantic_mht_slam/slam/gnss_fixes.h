#pragma once

#include <cstddef>
#include <deque>
#include <limits>
#include <optional>
#include <vector>

#include "semantic_mht_slam/common/config.h"
#include "semantic_mht_slam/graph/pose_graph.h"
#include "semantic_mht_slam/map/map.h"
#include "semantic_mht_slam/models/gnss_fix.h"
#include "semantic_mht_slam/slam/sessions.h"

namespace semantic_mht_slam {

class StateArchive;

/// How positions by satellites are used.
struct GnssConfig {
  bool use = true;
  double default_stddev_m = 5.0;
  double least_stddev_m = 0.5;
  double cov_scale = 4.0;
  double max_gap_s = 1.0;
  double max_delay_s = 2.0;
  double antenna_x_m = 0.0;
  double antenna_y_m = 0.0;
  double antenna_z_m = 0.0;
};

void describe(GnssConfig& config, Fields& fields);

/// What came in, what became of it, and what was dropped, since the beginning.
struct GnssCounters {
  std::size_t received = 0;
  std::size_t used = 0;                 ///< for a keyframe; there may be more fixes than keyframes
  std::size_t covariances_unknown = 0;  ///< the default deviation was taken
  std::size_t no_fix = 0;               ///< dropped: the receiver says so
  std::size_t invalid = 0;              ///< dropped: not finite, or out of range
  std::size_t too_coarse = 0;           ///< dropped: the horizontal standard deviation says nothing
  std::size_t null_island = 0;          ///< dropped: latitude and longitude are both zero
  std::size_t bad_stamps = 0;           ///< dropped: no time that ROS can write
  std::size_t repeated = 0;             ///< dropped: there is another one of that stamp
  std::size_t late = 0;                 ///< dropped: the keyframes of that time have been looked at
  std::size_t far_ahead = 0;            ///< dropped: the stamp is far ahead of the keyframes
  std::size_t far_away = 0;             ///< dropped: nowhere near the fixes before
  std::size_t no_odometry = 0;          ///< dropped: in a gap of the odometry
  std::size_t crowded_out = 0;          ///< dropped: the oldest of too many that waited for keyframes
};

/// What was counted since `before`.
GnssCounters operator-(GnssCounters counters, const GnssCounters& before);

/// Where the map is on the Earth.
struct GeoReference {
  GeodeticPoint origin;  ///< of the tangent plane east, north, up
  Pose T_enu_map;
};

/// Keeps the fixes that came until their keyframes are there, and makes positions of keyframes of them. Where no
/// keyframes come, the newest thousands are kept. The result
/// depends on stamps alone, not on the order of arrival, for fixes that are late by no more than `max_delay_s`.
class GnssFixes {
 public:
  explicit GnssFixes(const GnssConfig& config) : config_(config) {}

  /// Fixes that cannot be used are dropped and counted.
  void add(const GnssFix& fix);

  /// The positions of keyframes that have not been looked at, as far as they are older by `max_delay_s` than the newest
  /// one, or all of them. A keyframe gets the fix that is nearest in time, within `max_gap_s`, if no other keyframe is
  /// nearer to that; the odometry between the two says where in the keyframe the antenna was. The frame is east, north,
  /// up about the origin, which is the first fix that the next one confirms. While there are too few positions to place
  /// the map, a longer row of fixes far from there, which confirm each other, moves the origin to them.
  std::vector<OuterPosition> take(const Map& map, const Sessions& sessions, bool all);

  /// Another odometry begins, with other stamps.
  void beginSession(KeyframeId next);

  const std::optional<GeodeticPoint>& origin() const { return origin_; }
  const GnssCounters& counters() const { return counters_; }

  /// Into one without fixes, or out of one.
  void transfer(StateArchive& archive, const Map& map);

 private:
  struct Fix {
    Stamp stamp = 0;
    GeodeticPoint place;
    bool has_altitude = true;
    Eigen::Matrix3d cov_m2 = Eigen::Matrix3d::Identity();  ///< as it goes into the graph
    Eigen::Vector3d antenna_m = Eigen::Vector3d::Zero();

    /// At the altitude of `other` if its own is not known.
    GeodeticPoint beside(const GeodeticPoint& other) const;

    void transfer(StateArchive& archive);
  };

  bool isUsable(const GnssFix& fix);
  Eigen::Matrix3d covOf(const GnssFix& fix, bool has_altitude);
  const Fix* nearestTo(const Map& map, KeyframeId keyframe) const;
  std::optional<Eigen::Vector3d> confirmed(const Fix& fix);
  bool movesOrigin(const Fix& fix);
  void settleAltitude(GeodeticPoint& place, const Fix& fix);
  void forgetOld(Stamp newest);

  GnssConfig config_;
  std::deque<Fix> waiting_;  ///< by rising stamps
  KeyframeId first_{0};      ///< of the session
  KeyframeId next_{0};       ///< the first keyframe that was not looked at
  std::optional<Stamp> looked_until_;
  std::optional<GeodeticPoint> unconfirmed_;  ///< that may become the origin
  std::optional<GeodeticPoint> origin_;
  bool is_altitude_known_ = false;          ///< of the origin, or of what may become it
  std::optional<GeodeticPoint> elsewhere_;  ///< the newest fix, if it was far from the origin
  std::size_t elsewhere_row_ = 0;           ///< such fixes in a row that confirmed each other
  GnssCounters counters_;
};

class Slam;

/// As it is estimated; empty until the fixes determine it.
std::optional<GeoReference> geoReferenceOf(const Slam& slam);

}  // namespace semantic_mht_slam
