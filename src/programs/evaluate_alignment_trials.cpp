#include "evaluate_alignment_trials.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "semantic_mht_slam/common/assignment.h"
#include "semantic_mht_slam/common/stopwatch.h"

namespace semantic_mht_slam {
namespace {

constexpr double kPriorXy_m = 5.0;
constexpr double kPriorZ_m = 0.5;
constexpr double kPriorYaw_rad = 3.0 * M_PI / 180.0;
constexpr double kMaxDistance_m = 10.0;  // of the two baselines
constexpr double kRight_m = 0.5;
constexpr double kRight_rad = 0.02;
constexpr double kElsewhere_m = 60.0;

const std::vector<Displacement>& displacements() {
  static const std::vector<Displacement> list = {{0.0, 0.0}, {1.0, 0.5}, {2.0, 1.0},
                                                 {3.0, 2.0}, {5.0, 3.0}, {8.0, 4.0}};
  return list;
}

/// The true pose moved by `offset` in a random horizontal direction and turned by it to a random side.
Pose displaced(const Pose& T_map_base, const Displacement& offset, Rng rng) {
  const double direction_rad = rng.uniform(-M_PI, M_PI);
  const double angle_rad = (rng.bernoulli(0.5) ? 1.0 : -1.0) * offset.angle_deg * M_PI / 180.0;
  Pose result = T_map_base;
  result.translation_m += offset.distance_m * Eigen::Vector3d(std::cos(direction_rad), std::sin(direction_rad), 0.0);
  result.rotation = Eigen::AngleAxisd(angle_rad, Eigen::Vector3d::UnitZ()) * T_map_base.rotation;
  return result;
}

std::vector<int> nearestNeighbour(const AlignmentScene& scene, const Pose& T_map_base) {
  std::vector<int> result;
  for (const RegistrationPoint& detection : scene.detections) {
    const Eigen::Vector3d position_m = T_map_base * detection.position_m;
    double nearest_m = kMaxDistance_m;
    result.push_back(-1);
    for (std::size_t l = 0; l < scene.landmarks.size(); ++l) {
      if (scene.landmarks[l].class_index != detection.class_index) continue;
      const double distance_m = (scene.landmarks[l].position_m - position_m).norm();
      if (distance_m >= nearest_m) continue;
      nearest_m = distance_m;
      result.back() = static_cast<int>(l);
    }
  }
  return result;
}

std::vector<int> hungarian(const AlignmentScene& scene, const Pose& T_map_base) {
  const int landmarks = static_cast<int>(scene.landmarks.size());
  SparseCostMatrix costs;
  costs.clear(landmarks + static_cast<int>(scene.detections.size()));
  for (std::size_t i = 0; i < scene.detections.size(); ++i) {
    costs.addRow();
    for (int l = 0; l < landmarks; ++l) {
      if (scene.landmarks[l].class_index != scene.detections[i].class_index) continue;
      const double distance_m = (scene.landmarks[l].position_m - T_map_base * scene.detections[i].position_m).norm();
      if (distance_m < kMaxDistance_m) costs.add(l, distance_m);
    }
    costs.add(landmarks + static_cast<int>(i), kMaxDistance_m);
  }
  std::vector<int> result = AssignmentSolver().solve(costs)->column_for_row;
  for (int& l : result) l = l < landmarks ? l : -1;
  return result;
}

std::vector<RegistrationMode> hypotheses(const std::vector<RegistrationPoint>& detections,
                                         const std::vector<RegistrationPoint>& landmarks, const Pose& T_map_base,
                                         const ClassTable& classes, const RegistrationConfig& config) {
  return align(landmarks, detections, RegistrationPrior{T_map_base, kPriorXy_m, kPriorZ_m, kPriorYaw_rad}, classes,
               config);
}

/// Error in x, y and heading.
Eigen::Vector3d planarError(const Pose& estimate, const Pose& truth) {
  return {estimate.translation_m.x() - truth.translation_m.x(), estimate.translation_m.y() - truth.translation_m.y(),
          logRotation(estimate.rotation * truth.rotation.conjugate()).z()};
}

bool isRight(const RegistrationMode& hypothesis, const Pose& T_map_base) {
  const Eigen::Vector3d error = planarError(hypothesis.T_a_b, T_map_base);
  return error.head<2>().norm() < kRight_m && std::abs(error.z()) < kRight_rad;
}

double squaredError(const RegistrationMode& hypothesis, const Pose& T_map_base) {
  Eigen::Matrix<double, 3, 4> planar = Eigen::Matrix<double, 3, 4>::Zero();
  planar(0, 0) = planar(1, 1) = planar(2, 3) = 1.0;
  const Eigen::Matrix3d cov = planar * hypothesis.headingCov() * planar.transpose();
  const Eigen::Vector3d error = planarError(hypothesis.T_a_b, T_map_base);
  return error.dot(cov.inverse() * error);
}

/// Matches of the likeliest hypothesis, and what there is to say of all of them; sums until all frames are done.
std::vector<int> jointAlignment(const AlignmentScene& scene, const Pose& T_map_base, const ClassTable& classes,
                                const RegistrationConfig& config, AlignmentResult& result) {
  const Stopwatch watch;
  const std::vector<RegistrationMode> found =
      hypotheses(scene.detections, scene.landmarks, T_map_base, classes, config);
  result.milliseconds.push_back(watch.elapsed_ms());
  ++result.frames;
  result.hypotheses += static_cast<double>(found.size());
  result.any_right += std::any_of(found.begin(), found.end(), [&](const RegistrationMode& hypothesis) {
    return isRight(hypothesis, scene.T_map_base);
  });
  if (found.empty()) {
    ++result.none;
    return std::vector<int>(scene.detections.size(), -1);
  }
  if (isRight(found.front(), scene.T_map_base)) {
    ++result.best_right;
    result.nees += squaredError(found.front(), scene.T_map_base);
  }
  std::vector<int> landmark_for_detection(scene.detections.size(), -1);
  for (const RegisteredPair& pair : found.front().pairs) {
    landmark_for_detection[static_cast<std::size_t>(pair.b)] = pair.a;
  }
  return landmark_for_detection;
}

void score(const AlignmentScene& scene, const std::vector<int>& matches, MatchTally& tally) {
  for (std::size_t i = 0; i < matches.size(); ++i) {
    const std::vector<int>& right = scene.right_matches[i];
    if (right.empty()) {
      ++tally.others;
      tally.accepted += matches[i] >= 0;
      continue;
    }
    ++tally.scored;
    if (matches[i] < 0) {
      ++tally.missed;
    } else if (std::find(right.begin(), right.end(), matches[i]) == right.end()) {
      ++tally.wrong;
    }
  }
}

/// Each frame on the maps of some others that are far away.
ElsewhereResult layElsewhere(const std::vector<AlignmentScene>& scenes, const ClassTable& classes,
                             const RegistrationConfig& config) {
  ElsewhereResult result;
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    for (std::size_t part = 1; part < 6; ++part) {
      const AlignmentScene& other = scenes[(i + part * scenes.size() / 6) % scenes.size()];
      const Pose& T_map_base = other.T_map_base;
      if ((T_map_base.translation_m - scenes[i].T_map_base.translation_m).norm() < kElsewhere_m) continue;
      const auto found = hypotheses(scenes[i].detections, other.landmarks, T_map_base, classes, config);
      ++result.frames;
      result.believed += !found.empty();
      if (!found.empty()) {
        result.max_log_likelihood = std::max(result.max_log_likelihood, found.front().log_evidence);
      }
    }
  }
  return result;
}

}  // namespace

double MatchTally::share() const {
  return scored > 0 ? static_cast<double>(wrong + missed) / scored : std::numeric_limits<double>::quiet_NaN();
}

AlignmentTrials runAlignmentTrials(const std::vector<AlignmentScene>& scenes, const ClassTable& classes,
                                   const RegistrationConfig& config, const Rng& rng) {
  AlignmentTrials trials;
  std::vector<MethodResult> nearest_results, hungarian_results, joint_results;
  for (const Displacement& offset : displacements()) {
    MethodResult nearest{"nearest neighbour", offset, {}};
    MethodResult assigned{"Hungarian", offset, {}};
    MethodResult joint{"joint alignment", offset, {}};
    AlignmentResult alignment;
    alignment.offset = offset;
    for (const AlignmentScene& scene : scenes) {
      const Pose T_map_base = displaced(scene.T_map_base, offset, rng.fork("offset", scene.frame));
      score(scene, nearestNeighbour(scene, T_map_base), nearest.tally);
      score(scene, hungarian(scene, T_map_base), assigned.tally);
      score(scene, jointAlignment(scene, T_map_base, classes, config, alignment), joint.tally);
    }
    alignment.hypotheses /= std::max(1, alignment.frames);
    alignment.nees /= std::max(1, alignment.best_right);
    nearest_results.push_back(nearest);
    hungarian_results.push_back(assigned);
    joint_results.push_back(joint);
    trials.alignments.push_back(std::move(alignment));
  }
  for (const auto& results : {nearest_results, hungarian_results, joint_results}) {
    trials.methods.insert(trials.methods.end(), results.begin(), results.end());
  }
  trials.elsewhere = layElsewhere(scenes, classes, config);
  return trials;
}

}  // namespace semantic_mht_slam
