#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "semantic_mht_slam/common/random.h"
#include "semantic_mht_slam/registration/registration.h"

namespace semantic_mht_slam {
namespace testing {

using Points = std::vector<RegistrationPoint>;

constexpr ClassIndex kPole = 0;
constexpr ClassIndex kSign = 1;
constexpr ClassIndex kVehicle = 2;
constexpr ClassIndex kBuilding = 3;
constexpr ClassIndex kRider = 4;
constexpr double kPointStddev_m = 0.1;

inline ClassInfo classInfo(int id, const std::string& name, bool is_static, double transition_stddev_m) {
  ClassInfo info;
  info.id = id;
  info.name = name;
  info.is_static = is_static;
  info.transition = transition_stddev_m > 0.0 ? Transition::kGaussian : Transition::kDirac;
  info.transition_stddev_m = transition_stddev_m;
  return info;
}

inline ClassTable classTable() {
  return {{classInfo(1, "pole", true, 0.0), classInfo(2, "sign", true, 0.0), classInfo(3, "vehicle", false, 0.5),
           classInfo(4, "building", true, 2.0), classInfo(5, "rider", false, 0.5)},
          "test"};
}

inline RegistrationPoint point(const Eigen::Vector3d& position_m, ClassIndex class_index,
                               double stddev_m = kPointStddev_m) {
  return {position_m, stddev_m * stddev_m * Eigen::Matrix3d::Identity(), class_index};
}

inline Pose turned(const Pose& pose, double yaw_rad) {
  return {Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()) * pose.rotation, pose.translation_m};
}

/// Points of three classes scattered over a street, at least 3 m apart.
inline Points street(int count, Rng& rng) {
  Points points;
  while (static_cast<int>(points.size()) < count) {
    const Eigen::Vector3d position_m(rng.uniform(-35.0, 35.0), rng.uniform(-12.0, 12.0), rng.uniform(-1.0, 1.0));
    const bool is_free = std::all_of(points.begin(), points.end(), [&](const RegistrationPoint& other) {
      return (other.position_m - position_m).norm() > 3.0;
    });
    if (is_free) points.push_back(point(position_m, static_cast<ClassIndex>(rng.index(3))));
  }
  return points;
}

inline Points moved(Points points, const Pose& T_target_source) {
  const Eigen::Matrix3d rotation = T_target_source.rotation.toRotationMatrix();
  for (RegistrationPoint& p : points) {
    p.position_m = T_target_source * p.position_m;
    p.cov_m2 = rotation * p.cov_m2 * rotation.transpose();
    p.cov_m2 = 0.5 * (p.cov_m2 + p.cov_m2.transpose()).eval();
  }
  return points;
}

/// A map, a frame that sees it, and a prior that is off.
struct World {
  Points landmarks;
  Points detections;
  Pose T_a_b;
  RegistrationPrior prior;
};

inline World world(std::uint64_t seed, double noise_stddev_m, int count = 20) {
  Rng rng(seed);
  World result;
  const Pose T_b_street = turned({}, rng.uniform(-3.0, 3.0));
  const Points seen = moved(street(count, rng), T_b_street);
  result.T_a_b = {Eigen::Quaterniond(Eigen::AngleAxisd(rng.uniform(-3.0, 3.0), Eigen::Vector3d::UnitZ())),
                  {rng.uniform(-100.0, 100.0), rng.uniform(-100.0, 100.0), rng.uniform(-5.0, 5.0)}};
  result.landmarks = moved(seen, result.T_a_b);
  result.detections = seen;
  for (RegistrationPoint& detection : result.detections) {
    for (int k = 0; k < 3; ++k) detection.position_m(k) += rng.normal(0.0, noise_stddev_m);
  }
  result.prior = {turned(result.T_a_b, rng.uniform(-0.05, 0.05)), 4.0, 0.5, 0.03};
  result.prior.T_a_b.translation_m += Eigen::Vector3d(rng.uniform(-5.0, 5.0), rng.uniform(-5.0, 5.0), 0.2);
  return result;
}

inline std::vector<RegistrationMode> align(const World& w, const RegistrationConfig& config = {}) {
  return align(w.landmarks, w.detections, w.prior, classTable(), config);
}

/// Index in a of the counterpart of each of the `count` points of b, -1 for none.
inline std::vector<int> counterparts(const RegistrationMode& mode, int count) {
  std::vector<int> result(static_cast<std::size_t>(count), -1);
  for (const RegisteredPair& pair : mode.pairs) result[static_cast<std::size_t>(pair.b)] = pair.a;
  return result;
}

inline double softPairs(const RegistrationMode& mode) {
  double sum = 0.0;
  for (const RegisteredPair& pair : mode.pairs) sum += pair.right_prob;
  return sum;
}

/// Step on the right of `T_estimate` that leads to `T_truth`: translation, rotation.
inline Eigen::Matrix<double, 6, 1> errorOf(const Pose& T_estimate, const Pose& T_truth) {
  const Pose step = T_estimate.inverse() * T_truth;
  Eigen::Matrix<double, 6, 1> error;
  error << step.translation_m, logRotation(step.rotation);
  return error;
}

inline Eigen::Vector4d difference(const Pose& a, const Pose& b) {
  Eigen::Vector4d result;
  result << a.translation_m - b.translation_m, logRotation(a.rotation * b.rotation.conjugate()).z();
  return result;
}

inline std::vector<int> counting(int count) {
  std::vector<int> result;
  for (int i = 0; i < count; ++i) result.push_back(i);
  return result;
}

}  // namespace testing
}  // namespace semantic_mht_slam
