#include "alignment_refinement.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace semantic_mht_slam {
namespace {

constexpr double kLogTwoPi = 1.8378770664093453;
constexpr int kCoarseSteps = 2;
constexpr int kMaxSteps = 10;
constexpr double kConverged_m = 1e-4;
constexpr double kConverged_rad = 1e-6;

using Jacobian = Eigen::Matrix<double, 3, 4>;

/// Derivative of the moved detection by the state.
Jacobian jacobian(const AlignmentMatch& match) {
  Jacobian result = Jacobian::Zero();
  result.leftCols<3>().setIdentity();
  result(0, 3) = -match.turned_m.y();
  result(1, 3) = match.turned_m.x();
  return result;
}

/// Probability that a match is right rather than the detection being new.
double rightProb(const AlignmentMatch& match) {
  return 1.0 / (1.0 + std::exp(-match.log_odds));
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

Eigen::Matrix4d dataInformation(const std::vector<AlignmentMatch>& matches) {
  Eigen::Matrix4d sum = Eigen::Matrix4d::Zero();
  for (const AlignmentMatch& match : matches) {
    const Jacobian J = jacobian(match);
    sum += rightProb(match) * J.transpose() * match.information * J;
  }
  return sum;
}

Eigen::Matrix4d priorInformation(const AlignmentProblem& problem) {
  return problem.prior_stddev.cwiseAbs2().cwiseInverse().asDiagonal();
}

/// What all landmarks have in common if their errors are fully correlated, as those of one map are: the covariance that
/// a mean of them keeps, however many there are.
Eigen::Matrix3d commonLandmarkCov(const AlignmentProblem& problem, const std::vector<AlignmentMatch>& matches) {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  for (const AlignmentMatch& match : matches) information += problem.landmarks[match.landmark].cov_m2.inverse();
  return static_cast<double>(matches.size()) * information.inverse();
}

/// Covariance of the estimate when the detections' errors are independent and the landmarks' are common: the sandwich
/// of a weighted least-squares estimate whose weights include both.
Eigen::Matrix4d estimateCov(const AlignmentProblem& problem, const std::vector<AlignmentMatch>& matches) {
  Eigen::Matrix4d spread = priorInformation(problem);
  for (const AlignmentMatch& match : matches) {
    const Jacobian whitened = match.information * jacobian(match);
    const Eigen::Matrix3d independent = match.information.inverse() - problem.landmarks[match.landmark].cov_m2;
    spread += rightProb(match) * whitened.transpose() * independent * whitened;
  }
  const Eigen::Matrix4d inverse = (dataInformation(matches) + priorInformation(problem)).inverse();
  Eigen::Matrix4d cov = inverse * spread * inverse;
  cov.topLeftCorner<3, 3>() += commonLandmarkCov(problem, matches);
  return 0.5 * (cov + cov.transpose());
}

}  // namespace

void AlignmentRefinement::addPairs(int index, const AlignmentState& state, const Eigen::Matrix3d& turn,
                                   bool is_coarse) {
  const LevelledPoint& detection = problem_.detections[index];
  AlignmentMatch pair;
  pair.detection = index;
  const Eigen::Vector3d turned_m = turn * detection.position_m;
  pair.turned_m = turned_m.head<2>();
  Eigen::Matrix3d own_cov_m2 = turn * detection.cov_m2 * turn.transpose();
  double more_reach_m = 0.0;
  if (is_coarse) {
    const double turn_step_m = config_.yaw_step_rad * pair.turned_m.norm();
    const double variance_m2 = (config_.cell_m * config_.cell_m + turn_step_m * turn_step_m) / 4.0;
    own_cov_m2.diagonal() += Eigen::Vector3d(variance_m2, variance_m2, std::pow(problem_.prior_stddev(2), 2));
    more_reach_m = 3.0 * std::sqrt(variance_m2);
  }
  for (const AlignmentCandidate& candidate : problem_.candidates[index]) {
    pair.landmark = candidate.landmark;
    pair.residual_m = problem_.landmarks[candidate.landmark].position_m - turned_m - state.head<3>();
    const double reach_m = candidate.reach_m + more_reach_m;
    if (pair.residual_m.head<2>().squaredNorm() > reach_m * reach_m) continue;
    const Eigen::Matrix3d cov_m2 = own_cov_m2 + candidate.cov_m2;
    pair.information = cov_m2.inverse();
    pair.log_odds = candidate.log_odds - 0.5 * (3.0 * kLogTwoPi + std::log(cov_m2.determinant()) +
                                                pair.residual_m.dot(pair.information * pair.residual_m));
    if (pair.log_odds > 0.0) pairs_.push_back(pair);
  }
}

void AlignmentRefinement::match(const AlignmentState& state, bool is_coarse) {
  pairs_.clear();
  pair_of_entry_.clear();
  costs_.clear(static_cast<int>(problem_.landmarks.size() + problem_.detections.size()));
  const Eigen::Matrix3d turn = headingRotation(state(3));
  for (int i = 0; i < static_cast<int>(problem_.detections.size()); ++i) {
    const int first = static_cast<int>(pairs_.size());
    addPairs(i, state, turn, is_coarse);
    if (static_cast<int>(pairs_.size()) == first) continue;
    costs_.addRow();
    for (int p = first; p < static_cast<int>(pairs_.size()); ++p) {
      costs_.add(pairs_[p].landmark, -pairs_[p].log_odds);
      pair_of_entry_.push_back(p);
    }
    costs_.add(static_cast<int>(problem_.landmarks.size()) + i, 0.0);  // none
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

AlignmentState AlignmentRefinement::step(const AlignmentState& state) const {
  const Eigen::Matrix4d prior = priorInformation(problem_);
  Eigen::Vector4d gradient = -prior * state;
  for (const AlignmentMatch& match : matches_) {
    gradient += rightProb(match) * jacobian(match).transpose() * match.information * match.residual_m;
  }
  return (dataInformation(matches_) + prior).ldlt().solve(gradient);
}

bool AlignmentRefinement::isDetermined() const {
  if (static_cast<int>(matches_.size()) < config_.min_matches) return false;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> eigen(
      problem_.prior_stddev.asDiagonal() * dataInformation(matches_) * problem_.prior_stddev.asDiagonal(),
      Eigen::EigenvaluesOnly);
  return eigen.eigenvalues()(0) > 1.0;
}

/// The odds of the matches hold the expected share of matches; this replaces it by one that is itself uncertain (a beta
/// distribution), as much of a frame may be new or hidden together.
double AlignmentRefinement::logShareCorrection(bool is_static) const {
  int matched = 0;
  for (const AlignmentMatch& match : matches_) matched += problem_.is_static[match.detection] == is_static;
  int covered = 0;
  for (std::size_t i = 0; i < problem_.detections.size(); ++i) {
    covered += problem_.is_covered[i] && problem_.is_static[i] == is_static;
  }
  const double prob = is_static ? config_.static_match_prob : config_.movable_match_prob;
  const double log_odds = std::log(prob / (1.0 - prob));
  return logBetaBinomial(matched, std::max(covered, matched), prob, config_.match_concentration) - matched * log_odds;
}

AlignmentMode AlignmentRefinement::modeAt(const AlignmentState& state) const {
  AlignmentMode mode;
  mode.state = state;
  mode.matches = matches_;
  mode.cov = estimateCov(problem_, matches_);
  const Eigen::Matrix4d posterior = dataInformation(matches_) + priorInformation(problem_);
  mode.log_evidence = -0.5 * state.cwiseQuotient(problem_.prior_stddev).squaredNorm() -
                      problem_.prior_stddev.array().log().sum() - 0.5 * std::log(posterior.determinant());
  for (const AlignmentMatch& match : matches_) mode.log_evidence += match.log_odds;
  mode.log_evidence += logShareCorrection(true) + logShareCorrection(false);
  return mode;
}

std::optional<AlignmentMode> AlignmentRefinement::refine(const AlignmentState& seed) {
  AlignmentState state = seed;
  for (int i = 0; i < kMaxSteps; ++i) {
    match(state, i < kCoarseSteps);
    if (static_cast<int>(matches_.size()) < config_.min_matches) return std::nullopt;
    const AlignmentState change = step(state);
    state += change;
    if (i >= kCoarseSteps && change.head<3>().norm() < kConverged_m && std::abs(change(3)) < kConverged_rad) break;
  }
  match(state, false);
  if (!isDetermined()) return std::nullopt;
  return modeAt(state);
}

}  // namespace semantic_mht_slam
