#include <cmath>

#include "semantic_mht_slam/common/state_archive.h"
#include "semantic_mht_slam/common/state_checks.h"
#include "semantic_mht_slam/slam/gnss_fixes.h"

namespace semantic_mht_slam {
namespace {

constexpr double kFarthestAntenna_m = 1e4;

void transferPlace(StateArchive& archive, GeodeticPoint& place) {
  archive(place.latitude_deg, place.longitude_deg, place.altitude_m);
  archive.require(isOnEarth(place), "a place that is not on the Earth");
}

void transferPlace(StateArchive& archive, std::optional<GeodeticPoint>& place) {
  bool is_known = place.has_value();
  archive(is_known);
  if (archive.isReading() && is_known) place.emplace();
  if (is_known) transferPlace(archive, *place);
}

}  // namespace

void transfer(StateArchive& archive, GnssCounters& counters) {
  auto& [received, used, covariances_unknown, no_fix, invalid, too_coarse, null_island, bad_stamps, repeated, late,
         far_ahead, far_away, no_odometry, crowded_out] = counters;
  archive(received, used, covariances_unknown, no_fix, invalid, null_island, bad_stamps, repeated, late, far_ahead);
  archive(far_away, no_odometry, too_coarse, crowded_out);
}

void GnssFixes::Fix::transfer(StateArchive& archive) {
  archive(stamp);
  archive.requireStamp(stamp);
  transferPlace(archive, place);
  archive(has_altitude, cov_m2, antenna_m);
  archive.require(isPositive(cov_m2), "a fix whose covariance is not positive");
  archive.require(antenna_m.norm() <= kFarthestAntenna_m, "an antenna that is far from the vehicle");
}

void GnssFixes::transfer(StateArchive& archive, const Map& map) {
  archive(counters_, waiting_, first_, next_, looked_until_);
  transferPlace(archive, unconfirmed_);
  transferPlace(archive, origin_);
  archive(is_altitude_known_);
  transferPlace(archive, elsewhere_);
  archive(elsewhere_row_);
  archive.require(counters_.received > 0, "fixes without any");
  archive.require(areRising(waiting_, [](const Fix& fix) { return fix.stamp; }), "fixes whose stamps do not rise");
  archive.require(first_ <= next_ && next_ <= map.keyframes().nextId(), "fixes of keyframes that there are not");
  if (looked_until_) archive.requireStamp(*looked_until_);
}

}  // namespace semantic_mht_slam
