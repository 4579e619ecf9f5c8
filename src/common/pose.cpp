#include "semantic_mht_slam/common/pose.h"

#include <cmath>
#include <stdexcept>

namespace semantic_mht_slam {

Pose Pose::fromMatrix(const Eigen::Matrix<double, 3, 4>& matrix) {
  return {Eigen::Quaterniond(Eigen::Matrix3d(matrix.leftCols<3>())).normalized(), matrix.col(3)};
}

Eigen::Matrix<double, 3, 4> Pose::matrix() const {
  Eigen::Matrix<double, 3, 4> result;
  result << rotation.toRotationMatrix(), translation_m;
  return result;
}

Pose Pose::inverse() const {
  const Eigen::Quaterniond inverse_rotation = rotation.conjugate();
  return {inverse_rotation, -(inverse_rotation * translation_m)};
}

Pose Pose::operator*(const Pose& other) const {
  return {(rotation * other.rotation).normalized(), rotation * other.translation_m + translation_m};
}

bool Pose::isValid() const {
  return translation_m.allFinite() && rotation.coeffs().allFinite() && std::abs(rotation.norm() - 1.0) < 1e-6;
}

Eigen::Vector3d logRotation(const Eigen::Quaterniond& rotation) {
  const double sign = rotation.w() < 0.0 ? -1.0 : 1.0;  // the representative with the shorter way round
  const Eigen::Vector3d vector = sign * rotation.vec();
  const double sine = vector.norm();
  const double cosine = sign * rotation.w();
  // sin(x)/x -> 1: the second-order term is below the rounding error here
  const double scale = sine < 1e-10 ? 2.0 / cosine : 2.0 * std::atan2(sine, cosine) / sine;
  return scale * vector;
}

Eigen::Quaterniond expRotation(const Eigen::Vector3d& axis_angle_rad) {
  const double angle = axis_angle_rad.norm();
  const double scale = angle < 1e-10 ? 0.5 : std::sin(0.5 * angle) / angle;
  const Eigen::Vector3d vector = scale * axis_angle_rad;
  return Eigen::Quaterniond(std::cos(0.5 * angle), vector.x(), vector.y(), vector.z()).normalized();
}

double angularDistance(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  return logRotation(a.conjugate() * b).norm();
}

Pose interpolate(const Pose& from, const Pose& to, double fraction) {
  if (!(fraction >= 0.0 && fraction <= 1.0)) throw std::invalid_argument("interpolate: fraction outside [0, 1]");
  if (fraction == 0.0) return from;
  if (fraction == 1.0) return to;
  const Eigen::Vector3d step = logRotation(from.rotation.conjugate() * to.rotation);
  return {(from.rotation * expRotation(fraction * step)).normalized(),
          from.translation_m + fraction * (to.translation_m - from.translation_m)};
}

Pose normalized(const Pose& pose) {
  const double norm = pose.rotation.norm();
  if (!std::isfinite(norm) || norm < 1e-9) throw std::invalid_argument("quaternion without a direction");
  if (std::abs(norm - 1.0) < 1e-12) return pose;
  return {pose.rotation.normalized(), pose.translation_m};
}

}  // namespace semantic_mht_slam
