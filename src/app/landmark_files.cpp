#include "semantic_mht_slam/app/landmark_files.h"

#include <cmath>

#include <nlohmann/json.hpp>

#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/common/text.h"

namespace semantic_mht_slam {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kAhead_m = 100.0;          // on the x axis of the map, to see where that points
constexpr double kMostLatitude_deg = 89.9;  // closer to a pole there is no east worth the name

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

MapOrigin originOf(const GeoReference& reference) {
  const auto placeOf = [&](const Eigen::Vector3d& in_map_m) {
    return toGeodetic(reference.origin, reference.T_enu_map * in_map_m);
  };
  const GeodeticPoint origin = placeOf(Eigen::Vector3d::Zero());
  const Eigen::Vector3d ahead_m = toEastNorthUp(origin, placeOf({kAhead_m, 0.0, 0.0}));
  return {origin.latitude_deg, origin.longitude_deg, std::atan2(ahead_m.y(), ahead_m.x())};
}

void requireUsable(const MapOrigin& origin) {
  const auto isWithin = [](double value, double most) { return std::isfinite(value) && std::abs(value) <= most; };
  if (!isWithin(origin.latitude_deg, kMostLatitude_deg) || !isWithin(origin.longitude_deg, 180.0)) {
    throw InputError("the origin of the map must have a latitude within 89.9 and a longitude within 180 degrees");
  }
  if (!std::isfinite(origin.heading_rad)) throw InputError("the heading of the map's x axis is not finite");
}

Eigen::Vector2d toLatitudeLongitude(const MapOrigin& origin, const Eigen::Vector3d& position_m) {
  const Eigen::Vector3d east_north_up = Eigen::AngleAxisd(origin.heading_rad, Eigen::Vector3d::UnitZ()) * position_m;
  const GeodeticPoint place = toGeodetic({origin.latitude_deg, origin.longitude_deg, 0.0}, east_north_up);
  return {place.latitude_deg, place.longitude_deg};
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
