#include "semantic_mht_slam/slam/gnss_fixes.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "semantic_mht_slam/common/gaussian.h"
#include "semantic_mht_slam/common/ros_time.h"
#include "semantic_mht_slam/slam/slam.h"

namespace semantic_mht_slam {
namespace {

constexpr double kUnknownAltitudeStddev_m = 1000.0;
constexpr double kUpStddevRatio = 2.0;    // of a receiver that says nothing of its noise
constexpr double kMostVariance_m2 = 1e8;  // beyond, a fix says nothing
constexpr double kNextFix_m = 1000.0;     // from the one before
constexpr double kFarthestFix_m = 2e5;    // from the origin; the tangent plane is no plane of the drive any more
constexpr std::size_t kRowElsewhere = 6;  // fixes that outvote an origin of fewer positions, which place no map yet
constexpr double kNullIsland_deg = 1e-9;
constexpr Stamp kFarAheadOfKeyframes = 600LL * 1000000000LL;
constexpr std::size_t kMostWaiting = 6000;  // ten minutes of a fast receiver; no keyframe comes at known places

GeodeticPoint withAltitude(GeodeticPoint place, double altitude_m) {
  if (!std::isfinite(place.altitude_m)) place.altitude_m = altitude_m;
  return place;
}

/// False for a deviation that is not known, or that is no number.
bool isTooCoarse(const GnssFix& fix, int axis) {
  return fix.cov_m2 && (*fix.cov_m2)(axis, axis) > kMostVariance_m2;
}

bool hasAltitude(const GnssFix& fix) {
  return std::isfinite(fix.place.altitude_m) && !isTooCoarse(fix, 2);
}

void forgetAltitude(Eigen::Matrix3d& cov_m2) {
  cov_m2.row(2).setZero();
  cov_m2.col(2).setZero();
  cov_m2(2, 2) = kUnknownAltitudeStddev_m * kUnknownAltitudeStddev_m;
}

/// Between two keyframes.
Stamp middle(Stamp a, Stamp b) {
  return a + (b - a) / 2;
}

}  // namespace

void describe(GnssConfig& config, Fields& fields) {
  fields.add("use", config.use, "Whether positions by satellites are used where there are some (docs/gnss.md).");
  fields.add("default_stddev", config.default_stddev_m, "m", {1e-3, 1e3},
             "Horizontal standard deviation of fixes that come without a covariance; the vertical one is twice that.");
  fields.add("least_stddev", config.least_stddev_m, "m", {1e-3, 1e3},
             "Added to what a receiver says of itself, as variances.");
  fields.add("cov_scale", config.cov_scale, "", {1.0, 1e4},
             "Factor of the covariances: errors of fixes that follow each other are alike.");
  fields.add("max_gap", config.max_gap_s, "s", {1e-3, 60.0},
             "A keyframe gets the nearest fix if it is no further away in time.");
  fields.add("max_delay", config.max_delay_s, "s", {0.0, 60.0},
             "Keyframes wait this long, by the stamps of newer ones, for fixes that come late.");
  fields.add("antenna_x", config.antenna_x_m, "m", {-1e3, 1e3},
             "Where the antenna is in the base frame, if tf does not say it;");
  fields.add("antenna_y", config.antenna_y_m, "m", {-1e3, 1e3}, "y of that,");
  fields.add("antenna_z", config.antenna_z_m, "m", {-1e3, 1e3}, "and z.");
}

GnssCounters operator-(GnssCounters counters, const GnssCounters& before) {
  for (const auto member :
       {&GnssCounters::received, &GnssCounters::used, &GnssCounters::covariances_unknown, &GnssCounters::no_fix,
        &GnssCounters::invalid, &GnssCounters::too_coarse, &GnssCounters::null_island, &GnssCounters::bad_stamps,
        &GnssCounters::repeated, &GnssCounters::late, &GnssCounters::far_ahead, &GnssCounters::far_away,
        &GnssCounters::no_odometry, &GnssCounters::crowded_out}) {
    counters.*member -= before.*member;
  }
  return counters;
}

/// Counts why not.
bool GnssFixes::isUsable(const GnssFix& fix) {
  const auto drop = [](std::size_t& count) {
    ++count;
    return false;
  };
  if (!fix.has_fix) return drop(counters_.no_fix);
  const GeodeticPoint place = std::isnan(fix.place.altitude_m) ? withAltitude(fix.place, 0.0) : fix.place;
  const bool is_antenna = !fix.antenna_m || (fix.antenna_m->cwiseAbs().array() <= 1e3).all();
  if (!isOnEarth(place) || !is_antenna) return drop(counters_.invalid);
  if (isTooCoarse(fix, 0) || isTooCoarse(fix, 1)) return drop(counters_.too_coarse);
  const bool is_null =
      std::abs(place.latitude_deg) < kNullIsland_deg && std::abs(place.longitude_deg) < kNullIsland_deg;
  if (is_null) return drop(counters_.null_island);
  if (!isRosTime(fix.stamp)) return drop(counters_.bad_stamps);
  if (looked_until_ && fix.stamp < *looked_until_ - stampFromSeconds(config_.max_gap_s)) return drop(counters_.late);
  return true;
}

/// What goes into the graph.
Eigen::Matrix3d GnssFixes::covOf(const GnssFix& fix, bool has_altitude) {
  const double default_m2 = config_.default_stddev_m * config_.default_stddev_m;
  const double up_m2 = kUpStddevRatio * kUpStddevRatio * default_m2;
  Eigen::Matrix3d cov_m2 = Eigen::Vector3d(default_m2, default_m2, up_m2).asDiagonal();
  if (!has_altitude) forgetAltitude(cov_m2);
  std::optional<Eigen::Matrix3d> stated_m2 = fix.cov_m2;
  if (stated_m2 && !has_altitude) forgetAltitude(*stated_m2);
  const bool is_usable = stated_m2 && isCovariance(*stated_m2);
  counters_.covariances_unknown += is_usable ? 0 : 1;
  if (is_usable) cov_m2 = symmetric(*stated_m2);
  cov_m2.diagonal().array() += config_.least_stddev_m * config_.least_stddev_m;
  return config_.cov_scale * cov_m2;
}

void GnssFixes::add(const GnssFix& fix) {
  if (!config_.use) return;
  ++counters_.received;
  if (!isUsable(fix)) return;
  const auto place = std::lower_bound(waiting_.begin(), waiting_.end(), fix.stamp,
                                      [](const Fix& other, Stamp stamp) { return other.stamp < stamp; });
  if (place != waiting_.end() && place->stamp == fix.stamp) {
    ++counters_.repeated;
    return;
  }
  const Eigen::Vector3d configured_m(config_.antenna_x_m, config_.antenna_y_m, config_.antenna_z_m);
  const bool has_altitude = hasAltitude(fix);
  const GeodeticPoint at{fix.place.latitude_deg, fix.place.longitude_deg, has_altitude ? fix.place.altitude_m : 0.0};
  waiting_.insert(place, {fix.stamp, at, has_altitude, covOf(fix, has_altitude), fix.antenna_m.value_or(configured_m)});
  if (waiting_.size() <= kMostWaiting) return;
  waiting_.pop_front();
  ++counters_.crowded_out;
}

/// The fix that is nearest to a keyframe of those that are nearer to it than to its neighbours; null if there is none.
const GnssFixes::Fix* GnssFixes::nearestTo(const Map& map, KeyframeId keyframe) const {
  const Stamp at = map.keyframes()[keyframe].stamp;
  const Stamp gap = stampFromSeconds(config_.max_gap_s);
  Stamp begin = at - gap;
  Stamp end = at + gap;
  if (keyframe > first_)
    begin = std::max(begin, middle(map.keyframes()[KeyframeId(keyframe.index() - 1)].stamp, at) + 1);
  const KeyframeId after(keyframe.index() + 1);
  if (map.keyframes().has(after)) end = std::min(end, middle(at, map.keyframes()[after].stamp));
  const Fix* nearest = nullptr;
  const auto distance = [at](const Fix& fix) { return std::abs(fix.stamp - at); };
  auto fix = std::lower_bound(waiting_.begin(), waiting_.end(), begin,
                              [](const Fix& other, Stamp stamp) { return other.stamp < stamp; });
  for (; fix != waiting_.end() && fix->stamp <= end; ++fix) {
    if (nearest == nullptr || distance(*fix) < distance(*nearest)) nearest = &*fix;
  }
  return nearest;
}

GeodeticPoint GnssFixes::Fix::beside(const GeodeticPoint& other) const {
  return {place.latitude_deg, place.longitude_deg, has_altitude ? place.altitude_m : other.altitude_m};
}

/// A place that was taken without an altitude gets that of the first fix that knows one.
void GnssFixes::settleAltitude(GeodeticPoint& place, const Fix& fix) {
  if (is_altitude_known_ || !fix.has_altitude) return;
  place.altitude_m = fix.place.altitude_m;
  is_altitude_known_ = true;
}

/// Looks at a fix that is far from the origin. True if it ends a row that outvotes the origin, which is then here; the
/// few positions about the one before stay in the graph as wrong ones. Else the fix is dropped.
bool GnssFixes::movesOrigin(const Fix& fix) {
  const bool goes_on = elsewhere_ && toEastNorthUp(*elsewhere_, fix.beside(*elsewhere_)).norm() <= kNextFix_m;
  elsewhere_row_ = goes_on ? elsewhere_row_ + 1 : 1;
  elsewhere_ = fix.place;
  if (elsewhere_row_ < kRowElsewhere || counters_.used >= kRowElsewhere) {
    ++counters_.far_away;
    return false;
  }
  origin_ = fix.place;
  is_altitude_known_ = fix.has_altitude;
  return true;
}

/// The fix in the tangent plane; empty for one that is nowhere near those before.
std::optional<Eigen::Vector3d> GnssFixes::confirmed(const Fix& fix) {
  if (!origin_ && unconfirmed_) {
    settleAltitude(*unconfirmed_, fix);
    if (toEastNorthUp(*unconfirmed_, fix.beside(*unconfirmed_)).norm() <= kNextFix_m) {
      origin_ = std::exchange(unconfirmed_, std::nullopt);
    } else {
      ++counters_.far_away;
    }
  }
  if (!origin_) {
    unconfirmed_ = fix.place;
    is_altitude_known_ = fix.has_altitude;
    return std::nullopt;
  }
  const bool is_far = toEastNorthUp(*origin_, fix.beside(*origin_)).norm() > kFarthestFix_m;
  if (is_far && !movesOrigin(fix)) return std::nullopt;
  elsewhere_.reset();
  elsewhere_row_ = 0;
  settleAltitude(*origin_, fix);
  return toEastNorthUp(*origin_, fix.beside(*origin_));
}

void GnssFixes::forgetOld(Stamp newest) {
  if (looked_until_) {
    const Stamp first = *looked_until_ - stampFromSeconds(config_.max_gap_s);
    while (!waiting_.empty() && waiting_.front().stamp < first) waiting_.pop_front();
  }
  while (!waiting_.empty() && waiting_.back().stamp > newest + kFarAheadOfKeyframes) {
    waiting_.pop_back();
    ++counters_.far_ahead;
  }
}

std::vector<OuterPosition> GnssFixes::take(const Map& map, const Sessions& sessions, bool all) {
  std::vector<OuterPosition> positions;
  if (counters_.received == 0 || map.keyframes().empty() || map.keyframes().nextId() <= first_) return positions;
  const Stamp newest = map.keyframes().back().stamp;
  const Stamp until = all ? newest : newest - stampFromSeconds(config_.max_delay_s);
  for (; map.keyframes().has(next_) && map.keyframes()[next_].stamp <= until; ++next_) {
    const Keyframe& keyframe = map.keyframes()[next_];
    looked_until_ = keyframe.stamp;
    const Fix* fix = nearestTo(map, next_);
    if (fix == nullptr) continue;
    const std::optional<Pose> T_odom_base = sessions.odometryAt(fix->stamp, config_.max_gap_s);
    if (!T_odom_base) {
      ++counters_.no_odometry;
      continue;
    }
    const std::optional<Eigen::Vector3d> place_m = confirmed(*fix);
    if (!place_m) continue;
    const Pose T_keyframe_fix = keyframe.T_odom_base.inverse() * *T_odom_base;
    positions.push_back({static_cast<int>(next_.index()), T_keyframe_fix * fix->antenna_m, *place_m, fix->cov_m2});
    ++counters_.used;
  }
  forgetOld(newest);
  return positions;
}

void GnssFixes::beginSession(KeyframeId next) {
  first_ = next_ = next;
  waiting_.clear();
  looked_until_.reset();
}

std::optional<GeoReference> geoReferenceOf(const Slam& slam) {
  const std::optional<GeodeticPoint>& origin = slam.parts().fixes.origin();
  const std::optional<Pose> T_enu_map = slam.parts().graph.T_outer_map();
  if (!origin || !T_enu_map) return std::nullopt;
  return GeoReference{*origin, *T_enu_map};
}

}  // namespace semantic_mht_slam
