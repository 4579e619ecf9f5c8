#include "semantic_mht_slam/models/geodetic.h"

#include <cmath>

#include <GeographicLib/LocalCartesian.hpp>

namespace semantic_mht_slam {
namespace {

constexpr double kHighest_m = 1e5;

}  // namespace

bool isOnEarth(const GeodeticPoint& point) {
  return std::abs(point.latitude_deg) <= 90.0 && std::abs(point.longitude_deg) <= 180.0 &&
         std::abs(point.altitude_m) <= kHighest_m;
}

Eigen::Vector3d toEastNorthUp(const GeodeticPoint& origin, const GeodeticPoint& point) {
  const GeographicLib::LocalCartesian plane(origin.latitude_deg, origin.longitude_deg, origin.altitude_m);
  Eigen::Vector3d result;
  plane.Forward(point.latitude_deg, point.longitude_deg, point.altitude_m, result.x(), result.y(), result.z());
  return result;
}

GeodeticPoint toGeodetic(const GeodeticPoint& origin, const Eigen::Vector3d& east_north_up_m) {
  const GeographicLib::LocalCartesian plane(origin.latitude_deg, origin.longitude_deg, origin.altitude_m);
  GeodeticPoint result;
  plane.Reverse(east_north_up_m.x(), east_north_up_m.y(), east_north_up_m.z(), result.latitude_deg,
                result.longitude_deg, result.altitude_m);
  return result;
}

}  // namespace semantic_mht_slam
