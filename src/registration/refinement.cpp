#include "refinement.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "semantic_mht_slam/common/gaussian.h"

namespace semantic_mht_slam {
namespace {

constexpr int kCoarseSteps = 1;
constexpr int kMaxSteps = 10;
constexpr double kConverged_m = 1e-3;  // the pairs give the pose, more exactly
constexpr double kConverged_rad = 1e-5;

using Jacobian = Eigen::Matrix<double, 3, 4>;

/// Derivative of the moved detection by the state.
Jacobian jacobian(const WeighedPair& match) {
  Jacobian result = Jacobian::Zero();
  result.leftCols<3>().setIdentity();
  result(0, 3) = -match.turned_m.y();
  result(1, 3) = match.turned_m.x();
  return result;
}

/// Log probability that just these `matched` of `count` detections are matched, when the share is beta distributed with
/// this mean and `concentration` earlier observations.
double logBetaBinomial(int matched, int count, double mean, double concentration) {
  double result = 0.0;
  for (int i = 0; i < matched; ++i) result += std::log(concentration * mean + i);
  for (int i = 0; i < count - matched; ++i) result += std::log(concentration * (1.0 - mean) + i);
  for (int i = 0; i < count; ++i) result -= std::log(concentration + i);
  return result;
}

Eigen::Matrix4d dataInformation(const std::vector<WeighedPair>& matches) {
  Eigen::Matrix4d sum = Eigen::Matrix4d::Zero();
  for (const WeighedPair& match : matches) {
    const Jacobian J = jacobian(match);
    sum += rightProb(match) * J.transpose() * match.information * J;
  }
  return sum;
}

Eigen::Matrix4d posteriorInformation(const RegistrationProblem& problem, const std::vector<WeighedPair>& matches) {
  Eigen::Matrix4d sum = dataInformation(matches);
  sum.diagonal() += problem.prior.information;
  return sum;
}

}  // namespace

double rightProb(const WeighedPair& match) {
  return 1.0 / (1.0 + std::exp(-match.log_odds));
}

void Refinement::addPairs(int index, const PlanarState& state, const Eigen::Matrix3d& turn) {
  const LevelledPoint& detection = problem_.detections[index];
  const Eigen::Vector3d turned_m = turn * detection.position_m;
  const Eigen::Vector3d at_m = turned_m + state.head<3>();
  const Eigen::Matrix3d own_cov_m2 = turn * detection.cov_m2 * turn.transpose();
  WeighedPair pair;
  pair.detection = index;
  pair.turned_m = turned_m.head<2>();
  for (const PairCandidate& candidate : problem_.candidates[index]) {
    const LevelledPoint& landmark = problem_.landmarks[candidate.landmark];
    pair.residual_m = landmark.position_m - at_m;
    if (pair.residual_m.head<2>().squaredNorm() > candidate.reach_m * candidate.reach_m) continue;
    pair.landmark = candidate.landmark;
    const Eigen::Matrix3d cov_m2 = own_cov_m2 + landmark.cov_m2;
    double det = 0.0;
    bool is_invertible = false;
    cov_m2.computeInverseAndDetWithCheck(pair.information, det, is_invertible);
    pair.log_peak_odds = candidate.log_odds - 0.5 * (3.0 * kLogTwoPi + std::log(det));
    pair.log_odds = pair.log_peak_odds - 0.5 * pair.residual_m.dot(pair.information * pair.residual_m);
    if (is_invertible && pair.log_odds > 0.0) pairs_.push_back(pair);
  }
}

/// With the coarseness of the grid, beside which the shape of the covariances does not matter: they are circles here.
/// As on the grid, other classes say nothing.
void Refinement::addCoarsePairs(int index, const PlanarState& state, const Eigen::Matrix3d& turn) {
  const LevelledPoint& detection = problem_.detections[index];
  const Eigen::Vector3d turned_m = turn * detection.position_m;
  const Eigen::Vector3d at_m = turned_m + state.head<3>();
  const double turn_step_m = problem_.yaw_step_rad * turned_m.head<2>().norm();
  const double coarseness_m2 = (problem_.cell_m * problem_.cell_m + turn_step_m * turn_step_m) / 4.0;
  const double more_reach_m = 3.0 * std::sqrt(coarseness_m2);
  const double own_m2 = coarseness_m2 + 0.5 * (detection.cov_m2(0, 0) + detection.cov_m2(1, 1));
  const double own_height_m2 = detection.cov_m2(2, 2) + std::pow(problem_.prior.stddev(2), 2);
  WeighedPair pair;
  pair.detection = index;
  pair.turned_m = turned_m.head<2>();
  for (const PairCandidate& candidate : problem_.candidates[index]) {
    if (!candidate.is_same_class) continue;
    const LevelledPoint& landmark = problem_.landmarks[candidate.landmark];
    pair.residual_m = landmark.position_m - at_m;
    const double distance_sq = pair.residual_m.head<2>().squaredNorm();
    const double reach_m = candidate.reach_m + more_reach_m;
    if (distance_sq > reach_m * reach_m) continue;
    const double variance_m2 = own_m2 + 0.5 * (landmark.cov_m2(0, 0) + landmark.cov_m2(1, 1));
    const double height_m2 = own_height_m2 + landmark.cov_m2(2, 2);
    const double height_gap_m = pair.residual_m.z();
    pair.log_odds = candidate.log_odds - 0.5 * (3.0 * kLogTwoPi + std::log(variance_m2 * variance_m2 * height_m2) +
                                                distance_sq / variance_m2 + height_gap_m * height_gap_m / height_m2);
    if (pair.log_odds <= 0.0) continue;
    pair.landmark = candidate.landmark;
    pair.information.diagonal() << 1.0 / variance_m2, 1.0 / variance_m2, 1.0 / height_m2;
    pairs_.push_back(pair);
  }
}

void Refinement::match(const PlanarState& state, bool is_coarse) {
  pairs_.clear();
  pair_of_entry_.clear();
  const auto landmarks = static_cast<int>(problem_.landmarks.size());
  const auto detections = static_cast<int>(problem_.detections.size());
  costs_.clear(landmarks + detections);
  const Eigen::Matrix3d turn = headingRotation(state(3));
  for (int i = 0; i < detections; ++i) {
    const std::size_t first = pairs_.size();
    is_coarse ? addCoarsePairs(i, state, turn) : addPairs(i, state, turn);
    if (pairs_.size() == first) continue;
    costs_.addRow();
    for (std::size_t p = first; p < pairs_.size(); ++p) {
      costs_.add(pairs_[p].landmark, -pairs_[p].log_odds);
      pair_of_entry_.push_back(p);
    }
    costs_.add(landmarks + i, 0.0);  // none
    pair_of_entry_.push_back(-1);
  }
  matches_.clear();
  if (!solver_.solve(costs_, assignment_)) return;
  for (int row = 0; row < costs_.rows(); ++row) {
    for (int entry = costs_.rowBegin(row); entry < costs_.rowEnd(row); ++entry) {
      const bool is_chosen = costs_.column(entry) == assignment_.column_for_row[row];
      if (is_chosen && pair_of_entry_[entry] >= 0) matches_.push_back(pairs_[pair_of_entry_[entry]]);
    }
  }
}

PlanarState Refinement::step(const PlanarState& state) const {
  Eigen::Vector4d gradient = -state.cwiseProduct(problem_.prior.information);
  for (const WeighedPair& match : matches_) {
    gradient += rightProb(match) * jacobian(match).transpose() * match.information * match.residual_m;
  }
  return posteriorInformation(problem_, matches_).ldlt().solve(gradient);
}

bool Refinement::isDetermined() const {
  if (matches_.size() < min_matches_) return false;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> eigen(
      problem_.prior.stddev.asDiagonal() * dataInformation(matches_) * problem_.prior.stddev.asDiagonal(),
      Eigen::EigenvaluesOnly);
  return eigen.eigenvalues()(0) > 1.0;
}

/// True if there are landmarks around a detection, so that it should be in the map.
bool Refinement::isCovered(const LevelledPoint& detection, const PlanarState& state) const {
  const Eigen::Vector3d at_m = headingRotation(state(3)) * detection.position_m + state.head<3>();
  const double radius_sq = config_.density_radius_m * config_.density_radius_m;
  return std::any_of(problem_.landmarks.begin(), problem_.landmarks.end(), [&](const LevelledPoint& landmark) {
    return (landmark.position_m - at_m).head<2>().squaredNorm() < radius_sq;
  });
}

/// The odds of the matches hold the expected share of matches; this replaces it by one that is itself uncertain (a beta
/// distribution), as much of a frame may be new or hidden together.
double Refinement::logShareCorrection(bool is_static, const PlanarState& state) const {
  const auto isOfKind = [&](const LevelledPoint& detection) {
    return problem_.is_static[detection.class_index] == is_static;
  };
  int matched = 0;
  for (const WeighedPair& match : matches_) matched += isOfKind(problem_.detections[match.detection]);
  int covered = 0;
  for (const LevelledPoint& detection : problem_.detections) {
    covered += isOfKind(detection) && isCovered(detection, state);
  }
  const double prob = is_static ? config_.static_match_prob : config_.movable_match_prob;
  const double log_odds = std::log(prob / (1.0 - prob));
  return logBetaBinomial(matched, std::max(covered, matched), prob, config_.match_concentration) - matched * log_odds;
}

/// The evidence but for what the residuals of the pairs take off it.
double Refinement::logEvidenceWithoutResiduals(const PlanarState& state) const {
  double log_evidence = problem_.prior.log_peak + problem_.prior.logRatio(state) -
                        0.5 * std::log(posteriorInformation(problem_, matches_).determinant());
  for (const WeighedPair& match : matches_) log_evidence += match.log_peak_odds;
  return log_evidence + logShareCorrection(true, state) + logShareCorrection(false, state);
}

LocalOptimum Refinement::modeAt(const PlanarState& state) const {
  LocalOptimum mode{state, logEvidenceWithoutResiduals(state), matches_};
  for (const WeighedPair& match : matches_) mode.log_evidence += match.log_odds - match.log_peak_odds;
  return mode;
}

std::optional<LocalOptimum> Refinement::refine(const PlanarState& seed) {
  PlanarState state = seed;
  for (int i = 0; i < kMaxSteps; ++i) {
    match(state, i < kCoarseSteps);
    if (matches_.size() < min_matches_) return std::nullopt;
    // Even without any residual these pairs would not be likelier than "not here".
    if (i == kCoarseSteps && logEvidenceWithoutResiduals(state) < 0.0) return std::nullopt;
    const PlanarState change = step(state);
    state += change;
    if (i >= kCoarseSteps && change.head<3>().norm() < kConverged_m && std::abs(change(3)) < kConverged_rad) break;
  }
  match(state, false);
  if (!isDetermined()) return std::nullopt;
  return modeAt(state);
}

}  // namespace semantic_mht_slam
