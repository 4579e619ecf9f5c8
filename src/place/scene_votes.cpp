#include "scene_votes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace semantic_mht_slam {
namespace {

constexpr double kMinLength_m = 3.0;
constexpr double kMaxLength_m = 45.0;
constexpr double kMaxStddev_m = 0.9;  // of an object that votes: others give no heading
constexpr std::size_t kMaxVoters = 48;
constexpr double kCell_m = 1.5;
constexpr int kYawCells = 72;
constexpr int kHalfSide = 48;  // cells each way
constexpr int kSide = 2 * kHalfSide;

/// A pair of objects, directed from the lower class to the higher.
struct SegmentOfScene {
  int class_pair = 0;
  double length_m = 0.0;
  double heading_rad = 0.0;
  double stddev_m = 0.0;
  Eigen::Vector2d middle_m = Eigen::Vector2d::Zero();
  bool is_directed = true;  // false: both ends have one class
};

/// The objects that vote: the sharpest ones.
std::vector<PlanarObject> voters(const PlanarScene& scene) {
  std::vector<PlanarObject> result;
  for (const PlanarObject& object : scene.objects) {
    if (object.variance_m2 < kMaxStddev_m * kMaxStddev_m) result.push_back(object);
  }
  if (result.size() > kMaxVoters) {
    std::stable_sort(result.begin(), result.end(),
                     [](const PlanarObject& a, const PlanarObject& b) { return a.variance_m2 < b.variance_m2; });
    result.resize(kMaxVoters);
    std::stable_sort(result.begin(), result.end(),
                     [](const PlanarObject& a, const PlanarObject& b) { return a.class_index < b.class_index; });
  }
  return result;
}

std::vector<SegmentOfScene> segments(const PlanarScene& scene) {
  const std::vector<PlanarObject> objects = voters(scene);
  std::vector<SegmentOfScene> result;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    for (std::size_t k = i + 1; k < objects.size(); ++k) {
      const PlanarObject& a = objects[i];
      const PlanarObject& b = objects[k];
      const Eigen::Vector2d along_m = b.position_m - a.position_m;
      const double length_m = along_m.norm();
      if (length_m < kMinLength_m || length_m > kMaxLength_m) continue;
      result.push_back({a.class_index * kMaxClasses + b.class_index, length_m, std::atan2(along_m.y(), along_m.x()),
                        std::sqrt(a.variance_m2 + b.variance_m2), 0.5 * (a.position_m + b.position_m) - scene.centre_m,
                        a.class_index != b.class_index});
    }
  }
  std::sort(result.begin(), result.end(), [](const SegmentOfScene& a, const SegmentOfScene& b) {
    return a.class_pair != b.class_pair ? a.class_pair < b.class_pair : a.length_m < b.length_m;
  });
  return result;
}

/// What one cell got.
struct CellVotes {
  std::int32_t key = 0;
  float weight = 0.0F;
  float x_m = 0.0F;
  float y_m = 0.0F;
  float yaw_rad = 0.0F;  // relative to the middle of the cell
};

class VoteSheet {
 public:
  void add(double yaw_rad, const Eigen::Vector2d& shift_m, double weight) {
    const double turn = yaw_rad / (2.0 * M_PI);
    const double yaw_cells = (turn - std::floor(turn)) * kYawCells;
    const int yaw_cell = std::min(kYawCells - 1, static_cast<int>(yaw_cells));
    const int x = static_cast<int>(std::floor(shift_m.x() / kCell_m)) + kHalfSide;
    const int y = static_cast<int>(std::floor(shift_m.y() / kCell_m)) + kHalfSide;
    if (x < 0 || y < 0 || x >= kSide || y >= kSide) return;
    const double yaw_rest_rad = (yaw_cells - yaw_cell - 0.5) * 2.0 * M_PI / kYawCells;
    votes_.push_back({keyOf(yaw_cell, x, y), static_cast<float>(weight), static_cast<float>(weight * shift_m.x()),
                      static_cast<float>(weight * shift_m.y()), static_cast<float>(weight * yaw_rest_rad)});
  }

  std::vector<PlanarGuess> peaks(int count) {
    merge();
    std::vector<std::size_t> order(cells_.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    const std::size_t kept = std::min(order.size(), static_cast<std::size_t>(6 * count));
    std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(kept), order.end(),
                      [this](std::size_t a, std::size_t b) {
                        return cells_[a].weight != cells_[b].weight ? cells_[a].weight > cells_[b].weight
                                                                    : cells_[a].key < cells_[b].key;
                      });
    order.resize(kept);
    std::vector<PlanarGuess> guesses;
    for (const std::size_t i : order) guesses.push_back(around(cells_[i]));
    std::stable_sort(guesses.begin(), guesses.end(),
                     [](const PlanarGuess& a, const PlanarGuess& b) { return a.votes > b.votes; });
    return distinct(guesses, count);
  }

 private:
  static std::int32_t keyOf(int yaw, int x, int y) { return (yaw * kSide + x) * kSide + y; }

  void merge() {
    std::stable_sort(votes_.begin(), votes_.end(),
                     [](const CellVotes& a, const CellVotes& b) { return a.key < b.key; });
    for (const CellVotes& vote : votes_) {
      if (cells_.empty() || cells_.back().key != vote.key) {
        cells_.push_back(vote);
        continue;
      }
      CellVotes& cell = cells_.back();
      cell.weight += vote.weight;
      cell.x_m += vote.x_m;
      cell.y_m += vote.y_m;
      cell.yaw_rad += vote.yaw_rad;
    }
  }

  /// Mean over a cell and its neighbours.
  PlanarGuess around(const CellVotes& middle) const {
    const int yaw = middle.key / (kSide * kSide);
    const int x = middle.key / kSide % kSide;
    const int y = middle.key % kSide;
    PlanarGuess guess;
    double yaw_rad = 0.0;
    for (int turn = -1; turn <= 1; ++turn) {
      const int yaw_cell = (yaw + turn + kYawCells) % kYawCells;
      for (int dx = -1; dx <= 1; ++dx) {
        if (x + dx < 0 || x + dx >= kSide) continue;
        const std::int32_t first = keyOf(yaw_cell, x + dx, std::max(0, y - 1));
        const std::int32_t last = keyOf(yaw_cell, x + dx, std::min(kSide - 1, y + 1));
        auto cell = std::lower_bound(cells_.begin(), cells_.end(), first,
                                     [](const CellVotes& c, std::int32_t key) { return c.key < key; });
        for (; cell != cells_.end() && cell->key <= last; ++cell) {
          guess.votes += cell->weight;
          guess.shift_m += Eigen::Vector2d(cell->x_m, cell->y_m);
          yaw_rad += cell->yaw_rad + static_cast<double>(cell->weight) * turn * 2.0 * M_PI / kYawCells;
        }
      }
    }
    guess.shift_m /= guess.votes;
    guess.yaw_rad = (yaw + 0.5) * 2.0 * M_PI / kYawCells + yaw_rad / guess.votes;
    return guess;
  }

  static std::vector<PlanarGuess> distinct(const std::vector<PlanarGuess>& guesses, int count) {
    std::vector<PlanarGuess> result;
    for (const PlanarGuess& guess : guesses) {
      const bool is_near = std::any_of(result.begin(), result.end(), [&](const PlanarGuess& other) {
        return (guess.shift_m - other.shift_m).squaredNorm() < kCell_m * kCell_m &&
               std::cos(guess.yaw_rad - other.yaw_rad) > std::cos(2.0 * M_PI / kYawCells);
      });
      if (!is_near) result.push_back(guess);
      if (static_cast<int>(result.size()) == count) break;
    }
    return result;
  }

  std::vector<CellVotes> votes_;
  std::vector<CellVotes> cells_;
};

/// Segments of two scenes become votes.
struct Voting {
  Eigen::Vector2d query_centre_m;
  Eigen::Vector2d match_centre_m;
  double max_offset_m;
  VoteSheet sheet;
};

void vote(const SegmentOfScene& query, const SegmentOfScene& match, double tolerance_m, Voting& voting) {
  const double weight = 1.0 / (0.3 + tolerance_m);
  for (int way = 0; way < (query.is_directed ? 1 : 2); ++way) {
    const double yaw_rad = match.heading_rad - query.heading_rad + way * M_PI;
    const double c = std::cos(yaw_rad);
    const double s = std::sin(yaw_rad);
    Eigen::Matrix2d rotation;
    rotation << c, -s, s, c;
    const Eigen::Vector2d shift_m = match.middle_m - rotation * query.middle_m;
    const Eigen::Vector2d offset_m = voting.match_centre_m + shift_m - rotation * voting.query_centre_m;
    if (offset_m.squaredNorm() > voting.max_offset_m * voting.max_offset_m) continue;
    voting.sheet.add(yaw_rad, shift_m, weight);
  }
}

}  // namespace

std::vector<PlanarGuess> voteForMotions(const PlanarScene& query, const PlanarScene& match, double max_offset_m,
                                        int count) {
  const std::vector<SegmentOfScene> of_query = segments(query);
  const std::vector<SegmentOfScene> of_match = segments(match);
  Voting voting{query.centre_m, match.centre_m, max_offset_m, {}};
  std::size_t begin = 0;
  constexpr double kWidest_m = 2.0 * 1.5 * kMaxStddev_m;
  for (const SegmentOfScene& segment : of_query) {
    while (begin < of_match.size() && (of_match[begin].class_pair < segment.class_pair ||
                                       (of_match[begin].class_pair == segment.class_pair &&
                                        of_match[begin].length_m < segment.length_m - kWidest_m))) {
      ++begin;
    }
    for (std::size_t i = begin; i < of_match.size() && of_match[i].class_pair == segment.class_pair; ++i) {
      const SegmentOfScene& other = of_match[i];
      const double tolerance_m = 1.5 * std::hypot(segment.stddev_m, other.stddev_m);
      if (other.length_m > segment.length_m + tolerance_m) {
        if (other.length_m > segment.length_m + kWidest_m) break;
        continue;
      }
      if (other.length_m >= segment.length_m - tolerance_m) vote(segment, other, tolerance_m, voting);
    }
  }
  return voting.sheet.peaks(count);
}

}  // namespace semantic_mht_slam
