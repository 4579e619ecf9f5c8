#pragma once

#include <Eigen/Core>

namespace semantic_mht_slam {

/// A place by latitude and longitude (degrees) and height above the ellipsoid, WGS 84.
struct GeodeticPoint {
  double latitude_deg = 0.0;
  double longitude_deg = 0.0;
  double altitude_m = 0.0;
};

/// Whether it is finite, on the Earth, and nearer to its surface than 100 km.
bool isOnEarth(const GeodeticPoint& point);

/// The place in the frame east, north, up of the tangent plane at `origin`.
Eigen::Vector3d toEastNorthUp(const GeodeticPoint& origin, const GeodeticPoint& point);

/// The inverse.
GeodeticPoint toGeodetic(const GeodeticPoint& origin, const Eigen::Vector3d& east_north_up_m);

}  // namespace semantic_mht_slam
