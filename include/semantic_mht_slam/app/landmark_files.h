#pragma once

#include <optional>
#include <string>
#include <vector>

#include "semantic_mht_slam/map/landmark.h"
#include "semantic_mht_slam/models/class_table.h"
#include "semantic_mht_slam/slam/gnss_fixes.h"

namespace semantic_mht_slam {

/// Where the map frame is on the Earth.
struct MapOrigin {
  double latitude_deg = 0.0;   ///< WGS 84
  double longitude_deg = 0.0;  ///< WGS 84
  double heading_rad = 0.0;    ///< of the x axis, counterclockwise from east
};

/// The same as fixes determine it.
MapOrigin originOf(const GeoReference& reference);

/// Throws InputError for what is no place on the Earth between the poles.
void requireUsable(const MapOrigin& origin);

/// Latitude and longitude (degrees, WGS 84) of a place in the map frame, whose z axis is the vertical at the origin, on
/// the ellipsoid.
Eigen::Vector2d toLatitudeLongitude(const MapOrigin& origin, const Eigen::Vector3d& position_m);

/// id,class,x,y,z,existence,observations,sxx,sxy,sxz,syy,syz,szz,movable,seen_standing; map frame, m, m^2, s.
std::string landmarksCsv(const std::vector<MixtureLandmark>& landmarks, const ClassTable& classes);

/// GeoJSON (RFC 7946), a point a landmark. Without an origin the coordinates are metres of the map frame, which the
/// member `coordinates` says.
std::string landmarksGeoJson(const std::vector<MixtureLandmark>& landmarks, const ClassTable& classes,
                             const std::optional<MapOrigin>& origin);

}  // namespace semantic_mht_slam
