#include "semantic_mht_slam/graph/pose2.h"

#include <cmath>

namespace semantic_mht_slam {

double wrappedAngle(double angle_rad) {
  return std::remainder(angle_rad, 2.0 * M_PI);
}

Eigen::Matrix2d Pose2::rotationMatrix() const {
  const double c = std::cos(heading_rad);
  const double s = std::sin(heading_rad);
  Eigen::Matrix2d matrix;
  matrix << c, -s, s, c;
  return matrix;
}

Pose2 Pose2::inverse() const {
  return {-(rotationMatrix().transpose() * translation_m), -heading_rad};
}

Pose2 Pose2::operator*(const Pose2& other) const {
  return {*this * other.translation_m, wrappedAngle(heading_rad + other.heading_rad)};
}

Eigen::Vector2d Pose2::operator*(const Eigen::Vector2d& point_m) const {
  return rotationMatrix() * point_m + translation_m;
}

bool Pose2::isValid() const {
  return translation_m.allFinite() && std::isfinite(heading_rad);
}

}  // namespace semantic_mht_slam
