#include <algorithm>
#include <cmath>

#include "semantic_mht_slam/common/gaussian.h"

#include "first_guesses.h"
#include "vote_grid.h"

namespace semantic_mht_slam {
namespace {

/// The part of a candidate that counts on the grid.
struct PointVote {
  int detection = 0;
  Eigen::Vector2d landmark_m = Eigen::Vector2d::Zero();
  double log_peak_odds = 0.0;
  double half_information = 0.0;  ///< 1 / (2 variance), 1/m^2
  double radius_m = 0.0;
};

/// The odds in the plane: the height is averaged over its prior, the grid adds its own coarseness.
PointVote makeVote(const RegistrationProblem& problem, int detection, const PairCandidate& candidate) {
  const LevelledPoint& point = problem.detections[detection];
  const LevelledPoint& landmark = problem.landmarks[candidate.landmark];
  const Eigen::Matrix3d cov_m2 = point.cov_m2 + landmark.cov_m2;
  const double turn_step_m = problem.yaw_step_rad * point.position_m.head<2>().norm();
  const double coarseness_m2 = (2.0 * problem.cell_m * problem.cell_m + turn_step_m * turn_step_m) / 12.0;
  const double variance_m2 = 0.5 * (cov_m2(0, 0) + cov_m2(1, 1)) + coarseness_m2;
  const double height_variance_m2 = cov_m2(2, 2) + problem.prior.stddev(2) * problem.prior.stddev(2);
  const double height_gap_m = landmark.position_m.z() - point.position_m.z();

  PointVote vote;
  vote.detection = detection;
  vote.landmark_m = landmark.position_m.head<2>();
  vote.half_information = 0.5 / variance_m2;
  vote.log_peak_odds = candidate.log_odds - 0.5 * (3.0 * kLogTwoPi + std::log(height_variance_m2)) -
                       std::log(variance_m2) - 0.5 * height_gap_m * height_gap_m / height_variance_m2;
  vote.radius_m = std::sqrt(std::max(0.0, vote.log_peak_odds) / vote.half_information);
  return vote;
}

}  // namespace

std::vector<PlanarState> guessByPoints(const RegistrationProblem& problem, int count) {
  std::vector<PointVote> votes;
  int of_detection = 0;
  for (const std::vector<PairCandidate>& candidates : problem.candidates) {
    for (const PairCandidate& candidate : candidates) {
      if (!candidate.is_same_class) continue;
      const PointVote vote = makeVote(problem, of_detection, candidate);
      if (vote.log_peak_odds > 0.0) votes.push_back(vote);
    }
    ++of_detection;
  }
  if (votes.empty()) return {};
  VoteGrid grid(problem);
  return grid.peaks(count, [&](int layer) {
    const Eigen::Matrix2d rotation = headingRotation(grid.heading(layer)).topLeftCorner<2, 2>();
    int detection = -1;
    Eigen::Vector2d position_m = Eigen::Vector2d::Zero();
    for (const PointVote& vote : votes) {
      if (vote.detection != detection) {
        detection = vote.detection;
        position_m = rotation * problem.detections[detection].position_m.head<2>();
      }
      grid.addBest(detection, vote.landmark_m - position_m, vote.log_peak_odds, vote.half_information, vote.radius_m);
    }
  });
}

}  // namespace semantic_mht_slam
