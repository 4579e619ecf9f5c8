#include "semantic_mht_slam/registration/registration.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "first_guesses.h"
#include "pose_from_pairs.h"
#include "problem.h"
#include "refinement.h"

namespace semantic_mht_slam {
namespace {

bool isSame(const PlanarState& a, const PlanarState& b, const RegistrationConfig& config) {
  return (a - b).head<2>().norm() < config.distinct_m &&
         std::abs(std::remainder(a(3) - b(3), 2.0 * M_PI)) < config.distinct_rad;
}

/// Adds a mode unless it is there; of two that are the same, the likelier stays.
void addMode(std::vector<LocalOptimum>& modes, LocalOptimum mode, const RegistrationConfig& config) {
  for (LocalOptimum& known : modes) {
    if (!isSame(known.state, mode.state, config)) continue;
    if (mode.log_evidence > known.log_evidence) known = std::move(mode);
    return;
  }
  modes.push_back(std::move(mode));
}

std::vector<LocalOptimum> findModes(const RegistrationProblem& problem, const RegistrationConfig& config) {
  std::vector<LocalOptimum> modes;
  Refinement refinement(problem, config);
  for (const PlanarState& guess : firstGuesses(problem, config)) {
    std::optional<LocalOptimum> mode = refinement.refine(guess);
    const bool is_here = mode && mode->log_evidence > 0.0;
    if (!is_here || (problem.prior.is_open && !problem.prior.admits(mode->state))) continue;
    addMode(modes, std::move(*mode), config);
  }
  std::stable_sort(modes.begin(), modes.end(),
                   [](const LocalOptimum& a, const LocalOptimum& b) { return a.log_evidence > b.log_evidence; });
  const std::size_t max_modes = config.max_modes;
  if (modes.size() > max_modes) modes.resize(max_modes);
  return modes;
}

/// A level pose as a state says.
Pose poseAt(const PlanarState& state, const RegistrationProblem& problem, const Pose& prior_T_a_b) {
  return {(Eigen::Quaterniond(headingRotation(state(3))) * prior_T_a_b.rotation).normalized(),
          prior_T_a_b.translation_m + headingRotation(problem.prior_heading_rad) * state.head<3>()};
}

/// The pose by the pairs of a mode; empty if they leave it open.
std::optional<RegistrationMode> modeOf(const LocalOptimum& optimum, const RegistrationProblem& problem,
                                       const std::vector<RegistrationPoint>& a, const std::vector<RegistrationPoint>& b,
                                       const Pose& prior_T_a_b, const RegistrationConfig& config) {
  const Pose T_a_b = poseAt(optimum.state, problem, prior_T_a_b);
  const Eigen::Matrix3d R = T_a_b.rotation.toRotationMatrix();
  RegistrationMode mode;
  std::vector<PointPair> pairs;
  for (const WeighedPair& match : optimum.matches) {
    const int in_a = problem.landmarks[match.landmark].index;
    const int in_b = problem.detections[match.detection].index;
    const RegistrationPoint& point_a = a[in_a];
    const RegistrationPoint& point_b = b[in_b];
    PointPair pair{point_a.position_m, point_b.position_m, point_a.cov_m2 + R * point_b.cov_m2 * R.transpose(),
                   point_a.cov_m2, rightProb(match)};
    pair.cov_m2.diagonal().array() += problem.extra_variance_m2[point_a.class_index];
    pair.cov_m2(2, 2) += config.height_stddev_m * config.height_stddev_m;
    pairs.push_back(pair);
    mode.pairs.push_back({in_a, in_b, pair.weight});
  }
  const std::optional<PoseEstimate> estimate = poseFromPairs(T_a_b, pairs, config.tilt_stddev_rad);
  if (!estimate) return std::nullopt;
  mode.T_a_b = estimate->T_a_b;
  mode.cov = estimate->cov;
  mode.log_evidence = optimum.log_evidence;
  return mode;
}

}  // namespace

std::vector<RegistrationPoint> registrationPoints(const Scene& scene) {
  std::vector<RegistrationPoint> points;
  for (const SceneObject& object : scene.objects) {
    points.push_back({object.position_m, object.cov_m2, object.class_index});
  }
  return points;
}

Eigen::Matrix4d RegistrationMode::headingCov() const {
  const Eigen::Matrix3d R = T_a_b.rotation.toRotationMatrix();
  Eigen::Matrix<double, 4, 6> J = Eigen::Matrix<double, 4, 6>::Zero();
  J.topLeftCorner<3, 3>() = R;
  J.block<1, 3>(3, 3) = R.row(2);
  return J * cov * J.transpose();
}

std::vector<RegistrationMode> align(const std::vector<RegistrationPoint>& a, const std::vector<RegistrationPoint>& b,
                                    const std::optional<RegistrationPrior>& prior, const ClassTable& classes,
                                    const RegistrationConfig& config) {
  const RegistrationProblem problem = makeProblem(b, a, prior, classes, config);
  std::vector<RegistrationMode> result;
  for (const LocalOptimum& optimum : findModes(problem, config)) {
    auto mode = modeOf(optimum, problem, a, b, prior ? prior->T_a_b : Pose::identity(), config);
    if (mode) result.push_back(std::move(*mode));
  }
  return result;
}

}  // namespace semantic_mht_slam
