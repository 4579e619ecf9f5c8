#include "semantic_mht_slam/evaluation/rigid_alignment.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include <Eigen/Geometry>
#include <Eigen/SVD>

namespace semantic_mht_slam {
namespace {

using Points = std::vector<Eigen::Vector3d>;

/// Means of both sets and the sum of (target - mean) (source - mean)^T.
struct Moments {
  Eigen::Vector3d source_mean_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d target_mean_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d cross_m2 = Eigen::Matrix3d::Zero();
};

Eigen::Vector3d centroid(const Points& points) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points) sum += point;
  return sum / static_cast<double>(points.size());
}

Moments moments(const Points& source_m, const Points& target_m) {
  if (source_m.empty() || source_m.size() != target_m.size()) {
    throw std::invalid_argument("alignment of " + std::to_string(source_m.size()) + " points to " +
                                std::to_string(target_m.size()));
  }
  Moments result;
  result.source_mean_m = centroid(source_m);
  result.target_mean_m = centroid(target_m);
  for (std::size_t i = 0; i < source_m.size(); ++i) {
    result.cross_m2 += (target_m[i] - result.target_mean_m) * (source_m[i] - result.source_mean_m).transpose();
  }
  if (!result.cross_m2.allFinite()) throw std::invalid_argument("alignment of points that are not finite");
  return result;
}

Pose withRotation(const Eigen::Matrix3d& rotation, const Moments& moments) {
  return {Eigen::Quaterniond(rotation).normalized(), moments.target_mean_m - rotation * moments.source_mean_m};
}

}  // namespace

Pose rigidAlignment(const Points& source_m, const Points& target_m) {
  const Moments sums = moments(source_m, target_m);
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(sums.cross_m2, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double handedness = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0;
  const Eigen::Vector3d signs(1.0, 1.0, handedness);  // keeps a reflection out
  return withRotation(svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose(), sums);
}

Pose planarAlignment(const Points& source_m, const Points& target_m) {
  const Moments sums = moments(source_m, target_m);
  const Eigen::Matrix3d& cross = sums.cross_m2;
  const double yaw_rad = std::atan2(cross(1, 0) - cross(0, 1), cross(0, 0) + cross(1, 1));
  return withRotation(Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix(), sums);
}

}  // namespace semantic_mht_slam
