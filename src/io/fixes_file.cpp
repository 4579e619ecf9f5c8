#include "semantic_mht_slam/io/fixes_file.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "semantic_mht_slam/common/ros_time.h"
#include "semantic_mht_slam/io/csv_file.h"

namespace semantic_mht_slam {
namespace {

enum FixColumn : std::size_t { kTime, kLatitude, kLongitude, kAltitude, kStddevEast, kStddevNorth, kStddevUp };

const std::vector<std::string> kFixRequired = {"time", "latitude", "longitude"};
const std::vector<std::string> kFixOptional = {"altitude", "stddev_east", "stddev_north", "stddev_up"};

constexpr double kMostSeconds = 9e9;  // that nanoseconds can hold
constexpr double kUpStddev = 2.0;     // times the horizontal one, where only that is given

Stamp readTime(const CsvRow& row) {
  const double seconds = row.number(kTime);
  if (!(std::abs(seconds) < kMostSeconds)) row.fail(kTime, "is no time in seconds");
  return stampFromSeconds(seconds);
}

double readStddev(const CsvRow& row, std::size_t column) {
  const double stddev_m = row.number(column);
  if (!(stddev_m > 0.0)) row.fail(column, "is no standard deviation: it must be positive; leave it empty if unknown");
  return stddev_m;
}

std::optional<Eigen::Matrix3d> readCov(const CsvRow& row) {
  const bool has_east = row.has(kStddevEast);
  if (has_east != row.has(kStddevNorth)) {
    row.fail(has_east ? kStddevNorth : kStddevEast, "is empty, while the other horizontal one is not");
  }
  if (!has_east && row.has(kStddevUp)) row.fail(kStddevEast, "is empty, while stddev_up is not");
  if (!has_east) return std::nullopt;
  Eigen::Vector3d stddev_m(readStddev(row, kStddevEast), readStddev(row, kStddevNorth), 0.0);
  stddev_m.z() = row.has(kStddevUp) ? readStddev(row, kStddevUp) : kUpStddev * stddev_m.head<2>().maxCoeff();
  return Eigen::Matrix3d(stddev_m.cwiseAbs2().asDiagonal());
}

}  // namespace

FixesFile readFixes(const std::string& path) {
  FixesFile result;
  result.notice = CsvReader(kFixRequired, kFixOptional).read(path, [&](const CsvRow& row) {
    GnssFix& fix = result.fixes.emplace_back();
    fix.stamp = readTime(row);
    fix.place.latitude_deg = row.anyNumber(kLatitude);
    fix.place.longitude_deg = row.anyNumber(kLongitude);
    fix.place.altitude_m = row.optionalAnyNumber(kAltitude).value_or(std::numeric_limits<double>::quiet_NaN());
    fix.cov_m2 = readCov(row);
  });
  std::stable_sort(result.fixes.begin(), result.fixes.end(),
                   [](const GnssFix& a, const GnssFix& b) { return a.stamp < b.stamp; });
  return result;
}

}  // namespace semantic_mht_slam
