#include "vote_grid.h"

#include <algorithm>
#include <cmath>

#include "semantic_mht_slam/common/saturated.h"

namespace semantic_mht_slam {
namespace {

constexpr double kVotesPerNat = 64.0;
constexpr double kSharesOfOne = 1024.0;
constexpr double kMaxRadiusCells = 6.0;  // matches of loose classes say little beyond; bounds the time

}  // namespace

/// A cell whose score no neighbour's exceeds.
struct VoteGrid::Peak {
  double score = 0.0;
  std::size_t cell = 0;  ///< counted over all layers
  PlanarState state = PlanarState::Zero();
};

/// The highest peaks; of equal ones the first cells.
class VoteGrid::HighestPeaks {
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
      least_votes_ = std::max(0, saturatedInt(std::floor(peaks_.front().score * kVotesPerNat)));
    }
  }

  /// By falling score.
  std::vector<PlanarState> states() const {
    std::vector<Peak> sorted = peaks_;
    std::sort_heap(sorted.begin(), sorted.end(), isHigher);
    std::vector<PlanarState> states;
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

VoteGrid::VoteGrid(const RegistrationProblem& problem)
    : prior_(problem.prior),
      cell_m_(problem.cell_m),
      half_side_(saturatedInt(std::ceil(prior_.window(0) / cell_m_))),
      half_turns_(saturatedInt(std::ceil(prior_.window(3) / problem.yaw_step_rad))),
      yaw_step_rad_(prior_.is_open ? M_PI / half_turns_ : problem.yaw_step_rad),
      layers_(2 * half_turns_ + (prior_.is_open ? 0 : 1)),
      side_(2 * (half_side_ + kMargin) + 1),
      cells_in_row_(side_),
      best_voter_(cells_in_row_ * cells_in_row_, -1),
      best_score_(cells_in_row_ * cells_in_row_, 0) {}

/// An open heading goes round: there, the last layer is cast before the first one again, and the first after the last.
std::vector<PlanarState> VoteGrid::peaks(int count, const CastVotes& votes) {
  HighestPeaks highest(count);
  const int around = prior_.is_open ? 1 : 0;
  for (int layer = -around; layer < layers_ + around; ++layer) {
    cast(layer, votes);
    if (layer > 0) findPeaks(layer - 1, highest);
  }
  if (around == 0) findPeaks(layers_ - 1, highest);
  return highest.states();
}

void VoteGrid::cast(int layer, const CastVotes& votes) {
  voters_before_ += max_voter_;
  max_voter_ = 0;
  cast_layer_ = layer;
  scores(layer).assign(best_score_.size(), 0);
  votes((layer + layers_) % layers_);
}

void VoteGrid::addBest(int voter, const Eigen::Vector2d& at_m, double peak, double half_information, double radius_m) {
  max_voter_ = std::max(max_voter_, voter + 1);
  const Eigen::Vector2d center = at_m / cell_m_ + Eigen::Vector2d::Constant(half_side_ + kMargin);
  const double radius = std::min(kMaxRadiusCells, radius_m / cell_m_);
  const double scale = half_information * cell_m_ * cell_m_ * kVotesPerNat;
  const int y_end = std::min(side_ - 1, saturatedInt(std::floor(center.y() + radius)));
  const int x_begin = std::max(0, saturatedInt(std::ceil(center.x() - radius)));
  const int x_end = std::min(side_ - 1, saturatedInt(std::floor(center.x() + radius)));
  if (x_begin > x_end) return;
  std::vector<std::int32_t>& total = scores(cast_layer_);
  for (int y = std::max(0, saturatedInt(std::ceil(center.y() - radius))); y <= y_end; ++y) {
    const double dy = y - center.y();
    const double at_row = peak * kVotesPerNat - scale * dy * dy;
    const std::size_t first = cellOf(y, x_begin);
    addRow(static_cast<float>(at_row), static_cast<float>(scale), static_cast<float>(x_begin - center.x()),
           x_end - x_begin + 1, voters_before_ + voter, &best_voter_[first], &best_score_[first], &total[first]);
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

void VoteGrid::addShared(const Eigen::Vector2d& at_m, double weight) {
  const Eigen::Vector2d place = at_m / cell_m_ + Eigen::Vector2d::Constant(half_side_ + kMargin);
  const int x = saturatedInt(std::floor(place.x()));
  const int y = saturatedInt(std::floor(place.y()));
  if (x < 0 || y < 0 || x + 1 >= side_ || y + 1 >= side_) return;
  const double dx = place.x() - x;
  const double dy = place.y() - y;
  std::vector<std::int32_t>& total = scores(cast_layer_);
  const auto share = [&](double part) { return static_cast<std::int32_t>(weight * part * kSharesOfOne); };
  total[cellOf(y, x)] += share((1.0 - dx) * (1.0 - dy));
  total[cellOf(y, x + 1)] += share(dx * (1.0 - dy));
  total[cellOf(y + 1, x)] += share((1.0 - dx) * dy);
  total[cellOf(y + 1, x + 1)] += share(dx * dy);
}

/// Highest of its neighbours; among equal ones the first.
bool VoteGrid::isPeak(int layer, int y, int x) {
  const std::int32_t score = scores(layer)[cellOf(y, x)];
  for (int dl = -1; dl <= 1; ++dl) {
    if (!prior_.is_open && (layer + dl < 0 || layer + dl >= layers_)) continue;
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

/// Mean over a cell and its neighbours.
PlanarState VoteGrid::placeOf(int layer, int y, int x) {
  double total = 0.0;
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  for (int dl = -1; dl <= 1; ++dl) {
    if (!prior_.is_open && (layer + dl < 0 || layer + dl >= layers_)) continue;
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        const double votes = scores(layer + dl)[cellOf(y + dy, x + dx)];
        total += votes;
        moment += votes * Eigen::Vector3d(dx, dy, dl);
      }
    }
  }
  const int center = half_side_ + kMargin;
  const Eigen::Vector3d shift = moment / total;
  return {(x - center + shift.x()) * cell_m_, (y - center + shift.y()) * cell_m_, 0.0,
          heading(layer) + shift.z() * yaw_step_rad_};
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
  for (int x = begin; x < end; ++x) {
    if (row[x] <= peaks.leastVotes() || row[x] <= row[x - 1] || row[x] < row[x + 1]) continue;  // most end here
    if (!isPeak(layer, y, x)) continue;
    const PlanarState state = placeOf(layer, y, x);
    peaks.add({row[x] / kVotesPerNat + prior_.logRatio(state), layer * best_score_.size() + cellOf(y, x), state});
  }
}

}  // namespace semantic_mht_slam
