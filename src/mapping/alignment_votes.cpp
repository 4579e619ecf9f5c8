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

/// A cell whose score no neighbour's exceeds.
struct Peak {
  double score = 0.0;
  std::size_t cell = 0;  ///< counted over all layers
  AlignmentState state = AlignmentState::Zero();
};

/// The highest peaks; of equal ones the first cells.
class HighestPeaks {
 public:
  explicit HighestPeaks(std::size_t count) : count_(count) {}

  /// Votes of a cell that no peak of so few votes could be kept any more.
  std::int32_t leastVotes() const { return least_votes_; }

  void add(const Peak& peak) {
    peaks_.push_back(peak);
    std::push_heap(peaks_.begin(), peaks_.end(), isHigher);
    if (peaks_.size() > count_) {
      std::pop_heap(peaks_.begin(), peaks_.end(), isHigher);
      peaks_.pop_back();
    }
    if (peaks_.size() == count_) {
      least_votes_ = std::max(0, static_cast<std::int32_t>(std::floor(peaks_.front().score * kVotesPerNat)));
    }
  }

  /// By falling score.
  std::vector<AlignmentState> states() const {
    std::vector<Peak> sorted = peaks_;
    std::sort_heap(sorted.begin(), sorted.end(), isHigher);
    std::vector<AlignmentState> states;
    for (const Peak& peak : sorted) states.push_back(peak.state);
    return states;
  }

 private:
  static bool isHigher(const Peak& a, const Peak& b) {
    return a.score != b.score ? a.score > b.score : a.cell < b.cell;
  }

  std::size_t count_;
  std::vector<Peak> peaks_;  ///< a heap, the lowest in front
  std::int32_t least_votes_ = 0;
};

/// Scores over heading, y, x, of which three layers of one heading each are kept: as many as a peak has neighbours in.
/// Each layer has a border of `kMargin` cells, in which no peaks are looked for.
class VoteGrid {
 public:
  VoteGrid(const AlignmentProblem& problem, const std::vector<Vote>& votes, const JointAlignmentConfig& config)
      : problem_(problem),
        votes_(votes),
        cell_m_(config.cell_m),
        yaw_step_rad_(config.yaw_step_rad),
        half_side_(static_cast<int>(std::ceil(problem.window(0) / config.cell_m))),
        half_turns_(static_cast<int>(std::ceil(problem.window(3) / config.yaw_step_rad))),
        side_(2 * (half_side_ + kMargin) + 1),
        best_voter_(static_cast<std::size_t>(side_) * side_, -1),
        best_score_(static_cast<std::size_t>(side_) * side_, 0) {}

  HighestPeaks highestPeaks(std::size_t count) {
    HighestPeaks peaks(count);
    for (int layer = 0; layer <= 2 * half_turns_; ++layer) {
      vote(layer);
      if (layer > 0) findPeaks(layer - 1, peaks);
    }
    findPeaks(2 * half_turns_, peaks);
    return peaks;
  }

 private:
  static constexpr int kMargin = 1;
  static constexpr int kStretch = 32;

  double yaw(int layer) const { return (layer - half_turns_) * yaw_step_rad_; }
  std::size_t cellOf(int y, int x) const { return static_cast<std::size_t>(y) * side_ + x; }
  std::vector<std::int32_t>& scores(int layer) { return scores_[static_cast<std::size_t>(layer) % scores_.size()]; }

  void vote(int layer);
  void addVote(const Vote& vote, int voter, const Eigen::Vector2d& offset_m, std::vector<std::int32_t>& scores);
  static void addRow(float at_row, float scale, float first_dx, int count, std::int32_t voter,
                     std::int32_t* __restrict best_voter, std::int32_t* __restrict best_score,
                     std::int32_t* __restrict total);
  void findPeaks(int layer, HighestPeaks& peaks);
  void findPeaks(int layer, int y, int begin, int end, HighestPeaks& peaks);
  bool isPeak(int layer, int y, int x);

  const AlignmentProblem& problem_;
  const std::vector<Vote>& votes_;
  double cell_m_;
  double yaw_step_rad_;
  int half_side_;
  int half_turns_;
  int side_;
  std::array<std::vector<std::int32_t>, 3> scores_;
  // Of each cell of a layer: the detection that voted last, and its best vote, which a better one replaces.
  std::vector<std::int32_t> best_voter_;
  std::vector<std::int32_t> best_score_;
};

void VoteGrid::addVote(const Vote& vote, int voter, const Eigen::Vector2d& offset_m,
                       std::vector<std::int32_t>& scores) {
  const Eigen::Vector2d center = offset_m / cell_m_ + Eigen::Vector2d::Constant(half_side_ + kMargin);
  const double radius = vote.radius_cells;
  const double scale = vote.half_information * cell_m_ * cell_m_ * kVotesPerNat;
  const int y_end = std::min(side_ - 1, static_cast<int>(std::floor(center.y() + radius)));
  const int x_begin = std::max(0, static_cast<int>(std::ceil(center.x() - radius)));
  const int x_end = std::min(side_ - 1, static_cast<int>(std::floor(center.x() + radius)));
  if (x_begin > x_end) return;
  for (int y = std::max(0, static_cast<int>(std::ceil(center.y() - radius))); y <= y_end; ++y) {
    const double dy = y - center.y();
    const double at_row = vote.log_peak_odds * kVotesPerNat - scale * dy * dy;
    const std::size_t first = cellOf(y, x_begin);
    addRow(static_cast<float>(at_row), static_cast<float>(scale), static_cast<float>(x_begin - center.x()),
           x_end - x_begin + 1, voter, &best_voter_[first], &best_score_[first], &scores[first]);
  }
}

/// Without branches, so that compilers can work on several cells at once.
void VoteGrid::addRow(float at_row, float scale, float first_dx, int count, std::int32_t voter,
                      std::int32_t* __restrict best_voter, std::int32_t* __restrict best_score,
                      std::int32_t* __restrict total) {
  for (int x = 0; x < count; ++x) {
    const float dx = first_dx + static_cast<float>(x);
    const auto score = static_cast<std::int32_t>(at_row - scale * dx * dx);
    const std::int32_t before = best_voter[x] == voter ? best_score[x] : 0;
    const std::int32_t after = score > before ? score : before;
    total[x] += after - before;
    best_voter[x] = voter;
    best_score[x] = after;
  }
}

void VoteGrid::vote(int layer) {
  std::vector<std::int32_t>& layer_scores = scores(layer);
  layer_scores.assign(best_score_.size(), 0);
  const int detections = static_cast<int>(problem_.detections.size());
  const Eigen::Matrix2d rotation = headingRotation(yaw(layer)).topLeftCorner<2, 2>();
  int detection = -1;
  Eigen::Vector2d position_m = Eigen::Vector2d::Zero();
  for (const Vote& vote : votes_) {
    if (vote.detection != detection) {
      detection = vote.detection;
      position_m = rotation * problem_.detections[detection].position_m.head<2>();
    }
    addVote(vote, layer * detections + detection, vote.landmark_m - position_m, layer_scores);
  }
}

/// Highest of its neighbours; among equal ones the first.
bool VoteGrid::isPeak(int layer, int y, int x) {
  const std::int32_t score = scores(layer)[cellOf(y, x)];
  for (int dl = -1; dl <= 1; ++dl) {
    if (layer + dl < 0 || layer + dl > 2 * half_turns_) continue;
    const std::vector<std::int32_t>& others = scores(layer + dl);
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        const bool is_before = dl != 0 ? dl < 0 : dy != 0 ? dy < 0 : dx < 0;
        const std::int32_t other = others[cellOf(y + dy, x + dx)];
        if (other > score || (other == score && is_before)) return false;
      }
    }
  }
  return true;
}

void VoteGrid::findPeaks(int layer, HighestPeaks& peaks) {
  const int end = side_ - kMargin;
  for (int y = kMargin; y < end; ++y) {
    for (int x = kMargin; x < end; x += kStretch) findPeaks(layer, y, x, std::min(end, x + kStretch), peaks);
  }
}

/// Of a stretch of a row. Most stretches have nothing that is high enough.
void VoteGrid::findPeaks(int layer, int y, int begin, int end, HighestPeaks& peaks) {
  const std::int32_t* row = &scores(layer)[cellOf(y, 0)];
  const std::int32_t least = peaks.leastVotes();
  std::int32_t missing = 0;  // negative if some cell has more votes
  for (int x = begin; x < end; ++x) missing |= least - row[x];
  if (missing >= 0) return;
  const int center = half_side_ + kMargin;
  for (int x = begin; x < end; ++x) {
    if (row[x] <= peaks.leastVotes() || row[x] <= row[x - 1] || row[x] < row[x + 1]) continue;  // most end here
    if (!isPeak(layer, y, x)) continue;
    const AlignmentState state((x - center) * cell_m_, (y - center) * cell_m_, 0.0, yaw(layer));
    const double log_prior = -0.5 * state.cwiseQuotient(problem_.prior_stddev).squaredNorm();
    peaks.add({row[x] / kVotesPerNat + log_prior, layer * best_score_.size() + cellOf(y, x), state});
  }
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
  return VoteGrid(problem, votes, config).highestPeaks(static_cast<std::size_t>(config.max_seeds)).states();
}

}  // namespace semantic_mht_slam
