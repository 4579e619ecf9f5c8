#include "problem.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <tuple>

#include <Eigen/Geometry>

#include "semantic_mht_slam/common/gaussian.h"

#include "pair_candidates.h"

namespace semantic_mht_slam {
namespace {

constexpr double kOpenHeight_m = 1.0;                 // standard deviation of the height without a prior
constexpr double kOpenCells = 3.0, kOpenTurns = 5.0;  // how much coarser the grid is then: pairs of points vote

void check(const std::vector<RegistrationPoint>& points, const char* set, const ClassTable& classes) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const char* problem = nullptr;
    if (!points[i].position_m.allFinite())
      problem = " is not finite";
    else if (!isCovariance(points[i].cov_m2))
      problem = " has no positive definite covariance";
    else if (points[i].class_index < 0 || points[i].class_index >= classes.size())
      problem = " has an unknown class";
    if (problem == nullptr) continue;
    throw std::invalid_argument(std::string("align: point ") + std::to_string(i) + " of " + set + problem);
  }
}

void check(const RegistrationPrior& prior) {
  if (!prior.T_a_b.isValid()) throw std::invalid_argument("align: the prior is no pose");
  for (const double stddev : {prior.stddev_xy_m, prior.stddev_z_m, prior.stddev_yaw_rad}) {
    if (std::isfinite(stddev) && stddev > 0.0) continue;
    throw std::invalid_argument("align: the prior has a standard deviation that is not positive");
  }
}

/// Brings points into one order that depends on their values alone: by class, then by x.
void sortPoints(std::vector<LevelledPoint>& points) {
  const auto rest = [](const LevelledPoint& p) {
    return std::make_tuple(p.position_m.y(), p.position_m.z(), p.cov_m2(0, 0), p.cov_m2(1, 1), p.cov_m2(2, 2),
                           p.cov_m2(0, 1), p.cov_m2(0, 2), p.cov_m2(1, 2));
  };
  std::sort(points.begin(), points.end(), [&](const LevelledPoint& a, const LevelledPoint& b) {
    if (a.class_index != b.class_index) return a.class_index < b.class_index;
    if (a.position_m.x() != b.position_m.x()) return a.position_m.x() < b.position_m.x();
    return rest(a) < rest(b);
  });
}

/// The points after p -> rotation * (p - origin).
std::vector<LevelledPoint> levelled(const std::vector<RegistrationPoint>& points, const Eigen::Matrix3d& rotation,
                                    const Eigen::Vector3d& origin_m) {
  std::vector<LevelledPoint> result;
  result.reserve(points.size());
  for (const RegistrationPoint& point : points) {
    const Eigen::Matrix3d cov_m2 = rotation * point.cov_m2 * rotation.transpose();
    result.push_back({rotation * (point.position_m - origin_m), symmetric(cov_m2), point.class_index,
                      static_cast<int>(result.size())});
  }
  sortPoints(result);
  return result;
}

StatePrior normalPrior(const RegistrationPrior& prior, const RegistrationConfig& config) {
  StatePrior result;
  result.stddev << prior.stddev_xy_m, prior.stddev_xy_m, prior.stddev_z_m, prior.stddev_yaw_rad;
  result.information = result.stddev.cwiseAbs2().cwiseInverse();
  result.window = config.window_sigmas * result.stddev;
  result.window.head<3>() = result.window.head<3>().cwiseMin(config.max_window_m);
  result.window(3) = std::min(result.window(3), M_PI);
  result.log_peak = -result.stddev.array().log().sum();
  return result;
}

/// Any heading, and the origin of b anywhere within a disc.
StatePrior openPrior(const RegistrationConfig& config) {
  const double radius_m = config.max_offset_m;
  StatePrior result;
  result.is_open = true;
  result.stddev << 0.5 * radius_m, 0.5 * radius_m, kOpenHeight_m, M_PI / std::sqrt(3.0);
  result.information << 0.0, 0.0, 1.0 / (kOpenHeight_m * kOpenHeight_m), 0.0;
  result.window << radius_m, radius_m, config.window_sigmas * kOpenHeight_m, M_PI;
  result.log_peak = 1.5 * kLogTwoPi - std::log(M_PI * radius_m * radius_m * 2.0 * M_PI) - std::log(kOpenHeight_m);
  return result;
}

/// Adds to the height of each point what an error of roll and pitch moves it.
void addTilt(double tilt_stddev_rad, std::vector<LevelledPoint>& detections) {
  for (LevelledPoint& detection : detections) {
    detection.cov_m2(2, 2) += std::pow(tilt_stddev_rad * detection.position_m.head<2>().norm(), 2);
  }
}

/// Adds what a pair errs besides the covariances of its points.
void addPairErrors(const std::vector<double>& extra_variance_m2, double height_stddev_m,
                   std::vector<LevelledPoint>& landmarks) {
  for (LevelledPoint& landmark : landmarks) {
    landmark.cov_m2.diagonal().array() += extra_variance_m2[landmark.class_index];
    landmark.cov_m2(2, 2) += height_stddev_m * height_stddev_m;
  }
}

}  // namespace

Eigen::Matrix3d headingRotation(double yaw_rad) {
  return Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
}

bool StatePrior::admits(const PlanarState& state) const {
  if (is_open) return state.head<2>().norm() <= window(0);
  return (state.cwiseAbs().array() <= window.array()).all();
}

RegistrationProblem makeProblem(const std::vector<RegistrationPoint>& detections,
                                const std::vector<RegistrationPoint>& landmarks,
                                const std::optional<RegistrationPrior>& prior, const ClassTable& classes,
                                const RegistrationConfig& config) {
  check(detections, "b", classes);
  check(landmarks, "a", classes);
  if (prior) check(*prior);
  RegistrationProblem problem;
  problem.prior = prior ? normalPrior(*prior, config) : openPrior(config);
  problem.cell_m = config.cell_m * (prior ? 1.0 : kOpenCells);
  problem.yaw_step_rad = config.yaw_step_rad * (prior ? 1.0 : kOpenTurns);
  const Pose T_a_b = prior ? prior->T_a_b : Pose::identity();
  const Eigen::Matrix3d R_a_b = T_a_b.rotation.toRotationMatrix();
  problem.prior_heading_rad = std::atan2(R_a_b(1, 0), R_a_b(0, 0));
  const Eigen::Matrix3d R_level_a = headingRotation(-problem.prior_heading_rad);
  problem.detections = levelled(detections, R_level_a * R_a_b, Eigen::Vector3d::Zero());
  problem.landmarks = levelled(landmarks, R_level_a, T_a_b.translation_m);
  addTilt(config.tilt_stddev_rad, problem.detections);
  for (const ClassInfo& info : classes.all()) {
    const double transition_m = info.transition == Transition::kGaussian ? info.transition_stddev_m : 0.0;
    problem.extra_variance_m2.push_back(config.noise_floor_m * config.noise_floor_m + transition_m * transition_m);
    problem.is_static.push_back(info.is_static);
  }
  addPairErrors(problem.extra_variance_m2, config.height_stddev_m, problem.landmarks);
  problem.candidates = pairCandidates(problem, config);
  return problem;
}

}  // namespace semantic_mht_slam
