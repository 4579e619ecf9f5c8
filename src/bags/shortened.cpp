#include "shortened.h"

#include <cmath>

namespace semantic_mht_slam {
namespace {

void shorten(geometry_msgs::Point& point) {
  constexpr double kStep_m = 1.0 / 1024.0;
  for (double* value : {&point.x, &point.y, &point.z}) *value = kStep_m * std::round(*value / kStep_m);
}

void shorten(geometry_msgs::Quaternion& q) {
  constexpr double kStep = 1.0 / (1 << 20);
  for (double* value : {&q.x, &q.y, &q.z, &q.w}) *value = kStep * std::round(*value / kStep);
}

/// To four digits.
void shorten(double& value) {
  constexpr int kBits = 13;
  int exponent = 0;
  const double fraction = std::frexp(value, &exponent);
  value = std::ldexp(std::round(std::ldexp(fraction, kBits)), exponent - kBits);
}

}  // namespace

nav_msgs::Path shortened(nav_msgs::Path path) {
  for (geometry_msgs::PoseStamped& stamped : path.poses) {
    shorten(stamped.pose.position);
    shorten(stamped.pose.orientation);
  }
  return path;
}

SemanticMap shortened(SemanticMap map) {
  for (Landmark& landmark : map.landmarks) {
    shorten(landmark.position);
    for (double& value : landmark.class_probs) shorten(value);
    for (double& value : landmark.covariance) shorten(value);
    for (double* value :
         {&landmark.existence_prob, &landmark.seen_standing, &landmark.size.x, &landmark.size.y, &landmark.size.z}) {
      shorten(*value);
    }
    for (GaussianComponent& component : landmark.components) {
      shorten(component.weight);
      shorten(component.mean);
      for (double& value : component.covariance) shorten(value);
    }
  }
  return map;
}

}  // namespace semantic_mht_slam
