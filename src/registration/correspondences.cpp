#include "correspondences.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "semantic_mht_slam/common/max_clique.h"

#include "first_guesses.h"

namespace semantic_mht_slam {
namespace {

constexpr double kSignatureRadius_m = 30.0;
constexpr double kSignatureBin_m = 2.0;
constexpr int kSignatureBins = 15;
constexpr std::size_t kCliqueCandidates = 4;
constexpr int kMaxCliques = 3;
constexpr double kMinDistance_m = 1.0;
constexpr double kCliqueToleranceSigmas = 1.5;
constexpr long kCliqueSteps = 3000;

/// What stands around a point: counts by class and distance, each spread over the two nearest bins, unit length.
Eigen::VectorXd signature(const std::vector<LevelledPoint>& points, const LevelledPoint& point, Eigen::Index classes) {
  Eigen::VectorXd bins = Eigen::VectorXd::Zero(classes * kSignatureBins);
  for (const LevelledPoint& other : points) {
    const double distance_m = (other.position_m - point.position_m).head<2>().norm();
    if (&other == &point || distance_m >= kSignatureRadius_m) continue;
    const double place = std::max(0.0, distance_m / kSignatureBin_m - 0.5);
    const int bin = static_cast<int>(place);
    const double next = place - bin;
    bins(other.class_index * kSignatureBins + bin) += 1.0 - next;
    if (bin + 1 < kSignatureBins) bins(other.class_index * kSignatureBins + bin + 1) += next;
  }
  const double norm = bins.norm();
  return norm > 0.0 ? Eigen::VectorXd(bins / norm) : bins;
}

std::vector<Eigen::VectorXd> signatures(const std::vector<LevelledPoint>& points, Eigen::Index classes) {
  std::vector<Eigen::VectorXd> result;
  for (const LevelledPoint& point : points) result.push_back(signature(points, point, classes));
  return result;
}

/// Of each horizontal coordinate, mean of both.
double variance_m2(const LevelledPoint& point) {
  return 0.5 * (point.cov_m2(0, 0) + point.cov_m2(1, 1));
}

bool keepsDistance(const RegistrationProblem& problem, const Correspondence& a, const Correspondence& b) {
  if (a.detection == b.detection || a.landmark == b.landmark) return false;
  const LevelledPoint& da = problem.detections[a.detection];
  const LevelledPoint& db = problem.detections[b.detection];
  const LevelledPoint& la = problem.landmarks[a.landmark];
  const LevelledPoint& lb = problem.landmarks[b.landmark];
  const double of_detections_m = (da.position_m - db.position_m).head<2>().norm();
  const double of_landmarks_m = (la.position_m - lb.position_m).head<2>().norm();
  if (of_detections_m < kMinDistance_m || of_landmarks_m < kMinDistance_m) return false;
  const double stddev_m = std::sqrt(variance_m2(da) + variance_m2(db) + variance_m2(la) + variance_m2(lb));
  return std::abs(of_detections_m - of_landmarks_m) < kCliqueToleranceSigmas * stddev_m;
}

}  // namespace

std::vector<Correspondence> findCorrespondences(const RegistrationProblem& problem, std::size_t per_detection) {
  const Eigen::Index classes = problem.is_static.size();
  const std::vector<Eigen::VectorXd> of_detections = signatures(problem.detections, classes);
  const std::vector<Eigen::VectorXd> of_landmarks = signatures(problem.landmarks, classes);
  std::vector<Correspondence> result;
  Correspondence pair;
  for (const Eigen::VectorXd& of_detection : of_detections) {
    std::vector<std::pair<double, int>> ranked;  // the most alike first
    for (const PairCandidate& candidate : problem.candidates[pair.detection]) {
      if (!candidate.is_same_class) continue;
      ranked.emplace_back(-of_detection.dot(of_landmarks[candidate.landmark]), candidate.landmark);
    }
    std::sort(ranked.begin(), ranked.end());
    if (ranked.size() > per_detection) ranked.resize(per_detection);
    for (const auto& candidate : ranked) {
      pair.landmark = candidate.second;
      result.push_back(pair);
    }
    ++pair.detection;
  }
  return result;
}

PlanarState motionOf(const RegistrationProblem& problem, const std::vector<Correspondence>& correspondences) {
  if (correspondences.empty()) return PlanarState::Zero();
  Eigen::Vector3d source_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d target_m = Eigen::Vector3d::Zero();
  const double count = static_cast<double>(correspondences.size());
  for (const Correspondence& pair : correspondences) {
    source_m += problem.detections[pair.detection].position_m / count;
    target_m += problem.landmarks[pair.landmark].position_m / count;
  }
  Eigen::Matrix2d product_m2 = Eigen::Matrix2d::Zero();
  for (const Correspondence& pair : correspondences) {
    product_m2 += (problem.landmarks[pair.landmark].position_m - target_m).head<2>() *
                  (problem.detections[pair.detection].position_m - source_m).head<2>().transpose();
  }
  const double yaw_rad = std::atan2(product_m2(1, 0) - product_m2(0, 1), product_m2(0, 0) + product_m2(1, 1));
  PlanarState state;
  state << target_m - headingRotation(yaw_rad) * source_m, yaw_rad;
  return state;
}

std::vector<PlanarState> guessByCliques(const RegistrationProblem& problem) {
  std::vector<Correspondence> left = findCorrespondences(problem, kCliqueCandidates);
  std::vector<PlanarState> guesses;
  for (int round = 0; round < kMaxCliques && left.size() > 2; ++round) {
    BitGraph graph(static_cast<int>(left.size()));
    for (int a = 0; a < graph.size(); ++a) {
      for (int b = a + 1; b < graph.size(); ++b) {
        if (keepsDistance(problem, left[a], left[b])) graph.join(a, b);
      }
    }
    const std::vector<int> clique = maximumClique(graph, kCliqueSteps);
    if (clique.size() < 3) break;
    std::vector<Correspondence> chosen;
    for (const int node : clique) chosen.push_back(left[node]);
    guesses.push_back(motionOf(problem, chosen));
    for (auto node = clique.rbegin(); node != clique.rend(); ++node) left.erase(left.begin() + *node);
  }
  return guesses;
}

}  // namespace semantic_mht_slam
