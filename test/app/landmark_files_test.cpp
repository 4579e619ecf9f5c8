#include "semantic_mht_slam/app/landmark_files.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "support/expect_input_error.h"
#include "support/square_drive.h"

namespace semantic_mht_slam {
namespace {

MixtureLandmark landmarkAt(const Eigen::Vector3d& position_m) {
  MixtureLandmark landmark;
  landmark.id = 7;
  landmark.position = {position_m, Eigen::Vector3d(0.04, 0.09, 0.16).asDiagonal()};
  landmark.components = {{1.0, landmark.position}};
  landmark.class_probs = ClassProbs::Zero(2);
  landmark.class_probs(1) = 1.0;
  landmark.existence_prob = 0.9;
  landmark.observations = 3;
  return landmark;
}

TEST(LandmarkFilesTest, PlacesAreWhereTheRadiiOfCurvatureOfTheEllipsoidPutThem) {
  constexpr double kDegree = M_PI / 180.0;
  const double a = 6378137.0;
  const double e2 = 0.00669437999014;
  for (const double latitude_deg : {0.0, 47.3667, -33.9}) {
    const double sin2 = std::pow(std::sin(latitude_deg * kDegree), 2);
    const double meridian_m = a * (1.0 - e2) / std::pow(1.0 - e2 * sin2, 1.5);
    const double prime_m = a / std::sqrt(1.0 - e2 * sin2);
    for (const double heading_rad : {0.0, 0.5 * M_PI, 1.0}) {
      const MapOrigin origin{latitude_deg, 8.55, heading_rad};
      const Eigen::Vector2d here = toLatitudeLongitude(origin, Eigen::Vector3d::Zero());
      EXPECT_NEAR(here.x(), latitude_deg, 1e-10);
      EXPECT_NEAR(here.y(), 8.55, 1e-10);
      const Eigen::Vector2d place = toLatitudeLongitude(origin, {10.0, 0.0, 0.0});
      EXPECT_NEAR(place.x() - latitude_deg, 10.0 * std::sin(heading_rad) / meridian_m / kDegree, 1e-9);
      EXPECT_NEAR(place.y() - 8.55,
                  10.0 * std::cos(heading_rad) / (prime_m * std::cos(latitude_deg * kDegree)) / kDegree, 1e-9);
    }
  }
}

TEST(LandmarkFilesTest, GeoJsonHasAPointALandmark) {
  MixtureLandmark landmark = landmarkAt({100.0, 50.0, 1.5});
  landmark.size.add({{1.0, 2.0, 3.0}, 2});
  const ClassTable classes = makeStreetClasses();
  const auto json = nlohmann::json::parse(landmarksGeoJson({landmark}, classes, MapOrigin{47.0, 8.0, 0.0}));
  EXPECT_EQ(json["type"], "FeatureCollection");
  const auto& feature = json["features"].at(0);
  EXPECT_EQ(feature["geometry"]["type"], "Point");
  EXPECT_NEAR(feature["geometry"]["coordinates"][0].get<double>(), 8.0013, 1e-4) << "longitude first";
  EXPECT_NEAR(feature["geometry"]["coordinates"][1].get<double>(), 47.0004, 1e-4);
  EXPECT_EQ(feature["properties"]["class"], "trunk");
  EXPECT_EQ(feature["properties"]["stddev_m"], nlohmann::json({0.2, 0.3, 0.4}));
  EXPECT_EQ(feature["properties"]["size_m"], nlohmann::json({1.0, 2.0, 3.0}));
  const auto local = nlohmann::json::parse(landmarksGeoJson({landmark}, classes, std::nullopt));
  EXPECT_EQ(local["coordinates"], "x, y and z of the map frame, metres");
  EXPECT_EQ(local["features"][0]["geometry"]["coordinates"], nlohmann::json({100.0, 50.0, 1.5}));
}

TEST(LandmarkFilesTest, PlacesThatAreNoneAreRefused) {
  expectInputError([] { requireUsable({90.0, 0.0, 0.0}); }, {"latitude within 89.9"});
  expectInputError([] { requireUsable({0.0, 181.0, 0.0}); }, {"longitude within 180"});
  expectInputError([] { requireUsable({1.0, 1.0, std::numeric_limits<double>::infinity()}); }, {"not finite"});
}

}  // namespace
}  // namespace semantic_mht_slam
