#include "semantic_mht_slam/app/landmark_files.h"

#include <cmath>

#include <nlohmann/json.hpp>

#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/common/text.h"

namespace semantic_mht_slam {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kSemiMajor_m = 6378137.0;  // WGS 84
constexpr double kFlattening = 1.0 / 298.257223563;
constexpr double kEccentricitySq = kFlattening * (2.0 - kFlattening);
constexpr double kDegree = M_PI / 180.0;
constexpr double kMostLatitude_deg = 89.9;  // closer to a pole there is no east worth the name

/// Axes east, north and up at a place, in the axes of the Earth, as columns.
Eigen::Matrix3d eastNorthUp(double latitude_rad, double longitude_rad) {
  const double sin_lat = std::sin(latitude_rad);
  const double cos_lat = std::cos(latitude_rad);
  const double sin_lon = std::sin(longitude_rad);
  const double cos_lon = std::cos(longitude_rad);
  Eigen::Matrix3d axes;
  axes << -sin_lon, -sin_lat * cos_lon, cos_lat * cos_lon,  //
      cos_lon, -sin_lat * sin_lon, cos_lat * sin_lon,       //
      0.0, cos_lat, sin_lat;
  return axes;
}

Eigen::Vector3d onEllipsoid(double latitude_rad, double longitude_rad) {
  const double sin_lat = std::sin(latitude_rad);
  const double radius_m = kSemiMajor_m / std::sqrt(1.0 - kEccentricitySq * sin_lat * sin_lat);
  return {radius_m * std::cos(latitude_rad) * std::cos(longitude_rad),
          radius_m * std::cos(latitude_rad) * std::sin(longitude_rad), radius_m * (1.0 - kEccentricitySq) * sin_lat};
}

std::vector<double> asList(const Eigen::Vector3d& vector, int decimals) {
  std::vector<double> list;
  for (int i = 0; i < 3; ++i) list.push_back(*parseDouble(formatFixed(vector[i], decimals)));
  return list;
}

Json featureOf(const MixtureLandmark& landmark, const ClassTable& classes, const std::optional<MapOrigin>& origin) {
  constexpr int kDecimals = 9;  // of a degree, a tenth of a millimetre
  const Eigen::Vector3d& position_m = landmark.position.mean_m;
  Json coordinates = asList(position_m, 4);
  if (origin) {
    const Eigen::Vector2d place_deg = toLatitudeLongitude(*origin, position_m);
    coordinates = {*parseDouble(formatFixed(place_deg.y(), kDecimals)),
                   *parseDouble(formatFixed(place_deg.x(), kDecimals))};
  }
  const Eigen::Vector3d stddev_m = landmark.position.cov_m2.diagonal().cwiseMax(0.0).cwiseSqrt();
  Json properties = {{"id", landmark.id},
                     {"class", classes[landmark.mostLikelyClass()].name},
                     {"existence", landmark.existence_prob},
                     {"observations", landmark.observations},
                     {"map_position_m", asList(position_m, 4)},
                     {"stddev_m", asList(stddev_m, 4)},
                     {"locked", landmark.is_locked}};
  if (landmark.size.detections > 0) properties["size_m"] = asList(landmark.size.mean_m, 3);
  return {
      {"type", "Feature"}, {"geometry", {{"type", "Point"}, {"coordinates", coordinates}}}, {"properties", properties}};
}

}  // namespace

void requireUsable(const MapOrigin& origin) {
  const auto isWithin = [](double value, double most) { return std::isfinite(value) && std::abs(value) <= most; };
  if (!isWithin(origin.latitude_deg, kMostLatitude_deg) || !isWithin(origin.longitude_deg, 180.0)) {
    throw InputError("the origin of the map must have a latitude within 89.9 and a longitude within 180 degrees");
  }
  if (!std::isfinite(origin.heading_rad)) throw InputError("the heading of the map's x axis is not finite");
}

Eigen::Vector2d toLatitudeLongitude(const MapOrigin& origin, const Eigen::Vector3d& position_m) {
  const double latitude_rad = kDegree * origin.latitude_deg;
  const double longitude_rad = kDegree * origin.longitude_deg;
  const Eigen::Vector3d east_north_up = Eigen::AngleAxisd(origin.heading_rad, Eigen::Vector3d::UnitZ()) * position_m;
  const Eigen::Vector3d at =
      onEllipsoid(latitude_rad, longitude_rad) + eastNorthUp(latitude_rad, longitude_rad) * east_north_up;
  // Bowring, Transformation from spatial to geographical coordinates, Survey Review 1976: exact to micrometres near the
  // ground.
  const double semi_minor_m = kSemiMajor_m * (1.0 - kFlattening);
  const double planar_m = at.head<2>().norm();
  const double parametric = std::atan2(kSemiMajor_m * at.z(), semi_minor_m * planar_m);
  const double second_eccentricity_sq = kEccentricitySq / (1.0 - kEccentricitySq);
  const double latitude = std::atan2(at.z() + second_eccentricity_sq * semi_minor_m * std::pow(std::sin(parametric), 3),
                                     planar_m - kEccentricitySq * kSemiMajor_m * std::pow(std::cos(parametric), 3));
  return Eigen::Vector2d(latitude, std::atan2(at.y(), at.x())) / kDegree;
}

std::string landmarksCsv(const std::vector<MixtureLandmark>& landmarks, const ClassTable& classes) {
  std::string text = "id,class,x,y,z,existence,observations,sxx,sxy,sxz,syy,syz,szz,movable,seen_standing\n";
  for (const MixtureLandmark& landmark : landmarks) {
    text += std::to_string(landmark.id) + "," + classes[landmark.mostLikelyClass()].name;
    for (int i = 0; i < 3; ++i) text += "," + formatFixed(landmark.position.mean_m[i], 4);
    text += "," + formatFixed(landmark.existence_prob, 6) + "," + std::to_string(landmark.observations);
    const Eigen::Matrix3d& cov = landmark.position.cov_m2;
    for (Eigen::Index row = 0; row < 3; ++row) {
      for (Eigen::Index column = row; column < 3; ++column) text += "," + formatDouble(cov(row, column));
    }
    text += classes[landmark.mostLikelyClass()].is_static ? ",0," : ",1,";
    text += formatFixed(landmark.seen_standing_s, 3) + "\n";
  }
  return text;
}

std::string landmarksGeoJson(const std::vector<MixtureLandmark>& landmarks, const ClassTable& classes,
                             const std::optional<MapOrigin>& origin) {
  Json features = Json::array();
  for (const MixtureLandmark& landmark : landmarks) features.push_back(featureOf(landmark, classes, origin));
  const char* coordinates = origin ? "longitude and latitude, WGS 84" : "x, y and z of the map frame, metres";
  return Json{{"type", "FeatureCollection"}, {"coordinates", coordinates}, {"features", features}}.dump(1) + "\n";
}

}  // namespace semantic_mht_slam
