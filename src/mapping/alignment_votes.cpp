#include "alignment_votes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace semantic_mht_slam {
namespace {

constexpr double kLogTwoPi = 1.8378770664093453;
constexpr double kVotesPerNat = 64.0;
constexpr int kMaxRadiusCells = 6;  // matches of loose classes say little beyond; bounds the time

/// The part of a candidate that counts on the grid.
struct Vote {
  int detection = 0;
  Eigen::Vector2d landmark_m = Eigen::Vector2d::Zero();
  double log_peak_odds = 0.0;
  double half_information = 0.0;  ///< 1 / (2 variance), 1/m^2
  double radius_cells = 0.0;
};

/// Scores over heading, y, x. Each layer has a border of `kMargin` cells, in which no peaks are looked for: a peak has
/// neighbours on all sides.
class VoteGrid {
 public:
  VoteGrid(const Eigen::Vector4d& window, const JointAlignmentConfig& config)
      : cell_m_(config.cell_m),
        yaw_step_rad_(config.yaw_step_rad),
        half_side_(static_cast<int>(std::ceil(window(0) / config.cell_m))),
        half_turns_(static_cast<int>(std::ceil(window(3) / config.yaw_step_rad))),
        side_(2 * (half_side_ + kMargin) + 1),
        scores_(static_cast<std::size_t>(2 * half_turns_ + 1) * side_ * side_, 0),
        best_of_detection_(static_cast<std::size_t>(side_) * side_, {-1, 0}) {}

  void add(const AlignmentProblem& problem, const std::vector<Vote>& votes);
  std::vector<AlignmentState> peaks(const Eigen::Vector4d& prior_stddev, int count) const;

 private:
  static constexpr int kMargin = 1;

  /// The best vote of the detection that voted last in a cell, which a better one replaces.
  struct CellVote {
    std::int32_t voter = -1;
    std::int32_t score = 0;
  };
  struct Peak {
    double score = 0.0;
    std::size_t cell = 0;
    AlignmentState state = AlignmentState::Zero();
  };

  double yaw(int layer) const { return (layer - half_turns_) * yaw_step_rad_; }
  std::size_t cellOf(int layer, int y, int x) const {
    return (static_cast<std::size_t>(layer) * side_ + y) * side_ + x;
  }
  void addVote(const Vote& vote, int layer, int voter, const Eigen::Vector2d& offset_m);
  bool isPeak(int layer, int y, int x) const;

  double cell_m_;
  double yaw_step_rad_;
  int half_side_;
  int half_turns_;
  int side_;
  std::vector<std::int32_t> scores_;
  std::vector<CellVote> best_of_detection_;
};

void VoteGrid::addVote(const Vote& vote, int layer, int voter, const Eigen::Vector2d& offset_m) {
  const Eigen::Vector2d center = offset_m / cell_m_ + Eigen::Vector2d::Constant(half_side_ + kMargin);
  const double radius = vote.radius_cells;
  const double scale = vote.half_information * cell_m_ * cell_m_ * kVotesPerNat;
  const int y_end = std::min(side_ - 1, static_cast<int>(std::floor(center.y() + radius)));
  const int x_begin = std::max(0, static_cast<int>(std::ceil(center.x() - radius)));
  const int x_end = std::min(side_ - 1, static_cast<int>(std::floor(center.x() + radius)));
  for (int y = std::max(0, static_cast<int>(std::ceil(center.y() - radius))); y <= y_end; ++y) {
    const double dy = y - center.y();
    const double at_row = vote.log_peak_odds * kVotesPerNat - scale * dy * dy;
    CellVote* best = best_of_detection_.data() + cellOf(0, y, 0);
    std::int32_t* total = scores_.data() + cellOf(layer, y, 0);
    for (int x = x_begin; x <= x_end; ++x) {
      const double dx = x - center.x();
      const auto score = static_cast<std::int32_t>(at_row - scale * dx * dx);
      const std::int32_t before = best[x].voter == voter ? best[x].score : 0;
      if (score <= before) continue;
      total[x] += score - before;
      best[x] = {voter, score};
    }
  }
}

void VoteGrid::add(const AlignmentProblem& problem, const std::vector<Vote>& votes) {
  const int detections = static_cast<int>(problem.detections.size());
  for (int layer = 0; layer <= 2 * half_turns_; ++layer) {
    const Eigen::Matrix2d rotation = headingRotation(yaw(layer)).topLeftCorner<2, 2>();
    int detection = -1;
    Eigen::Vector2d position_m = Eigen::Vector2d::Zero();
    for (const Vote& vote : votes) {
      if (vote.detection != detection) {
        detection = vote.detection;
        position_m = rotation * problem.detections[detection].position_m.head<2>();
      }
      addVote(vote, layer, layer * detections + detection, vote.landmark_m - position_m);
    }
  }
}

/// Highest of its neighbours; among equal ones the first.
bool VoteGrid::isPeak(int layer, int y, int x) const {
  const std::size_t cell = cellOf(layer, y, x);
  for (int dl = -1; dl <= 1; ++dl) {
    if (layer + dl < 0 || layer + dl > 2 * half_turns_) continue;
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        const std::size_t other = cellOf(layer + dl, y + dy, x + dx);
        if (scores_[other] > scores_[cell] || (scores_[other] == scores_[cell] && other < cell)) return false;
      }
    }
  }
  return true;
}

std::vector<AlignmentState> VoteGrid::peaks(const Eigen::Vector4d& prior_stddev, int count) const {
  std::vector<Peak> peaks;
  for (int layer = 0; layer <= 2 * half_turns_; ++layer) {
    for (int y = kMargin; y < side_ - kMargin; ++y) {
      for (int x = kMargin; x < side_ - kMargin; ++x) {
        const std::size_t cell = cellOf(layer, y, x);
        if (scores_[cell] <= 0 || !isPeak(layer, y, x)) continue;
        const int center = half_side_ + kMargin;
        const AlignmentState state((x - center) * cell_m_, (y - center) * cell_m_, 0.0, yaw(layer));
        const double log_prior = -0.5 * state.cwiseQuotient(prior_stddev).squaredNorm();
        peaks.push_back({scores_[cell] / kVotesPerNat + log_prior, cell, state});
      }
    }
  }
  const std::size_t kept = std::min<std::size_t>(peaks.size(), count);
  std::partial_sort(peaks.begin(), peaks.begin() + kept, peaks.end(), [](const Peak& a, const Peak& b) {
    return a.score != b.score ? a.score > b.score : a.cell < b.cell;
  });
  std::vector<AlignmentState> states;
  for (std::size_t i = 0; i < kept; ++i) states.push_back(peaks[i].state);
  return states;
}

/// The odds in the plane: the height is averaged over its prior, the grid adds its own coarseness.
Vote makeVote(const AlignmentProblem& problem, int detection, const AlignmentCandidate& candidate,
              const JointAlignmentConfig& config) {
  const LevelledPoint& point = problem.detections[detection];
  const LevelledPoint& landmark = problem.landmarks[candidate.landmark];
  const Eigen::Matrix3d cov_m2 = point.cov_m2 + candidate.cov_m2;
  const double turn_step_m = config.yaw_step_rad * point.position_m.head<2>().norm();
  const double coarseness_m2 = (2.0 * config.cell_m * config.cell_m + turn_step_m * turn_step_m) / 12.0;
  const double variance_m2 = 0.5 * (cov_m2(0, 0) + cov_m2(1, 1)) + coarseness_m2;
  const double height_variance_m2 = cov_m2(2, 2) + problem.prior_stddev(2) * problem.prior_stddev(2);
  const double height_gap_m = landmark.position_m.z() - point.position_m.z();

  Vote vote;
  vote.detection = detection;
  vote.landmark_m = landmark.position_m.head<2>();
  vote.half_information = 0.5 / variance_m2;
  vote.log_peak_odds = candidate.log_odds - 0.5 * (3.0 * kLogTwoPi + std::log(height_variance_m2)) -
                       std::log(variance_m2) - 0.5 * height_gap_m * height_gap_m / height_variance_m2;
  const double radius_m = std::sqrt(std::max(0.0, vote.log_peak_odds) / vote.half_information);
  vote.radius_cells = std::min<double>(kMaxRadiusCells, radius_m / config.cell_m);
  return vote;
}

}  // namespace

std::vector<AlignmentState> alignmentSeeds(const AlignmentProblem& problem, const JointAlignmentConfig& config) {
  std::vector<Vote> votes;
  for (std::size_t i = 0; i < problem.candidates.size(); ++i) {
    for (const AlignmentCandidate& candidate : problem.candidates[i]) {
      if (!candidate.is_same_class) continue;
      const Vote vote = makeVote(problem, static_cast<int>(i), candidate, config);
      if (vote.log_peak_odds > 0.0) votes.push_back(vote);
    }
  }
  if (votes.empty()) return {};
  VoteGrid grid(problem.window, config);
  grid.add(problem, votes);
  return grid.peaks(problem.prior_stddev, config.max_seeds);
}

}  // namespace semantic_mht_slam
