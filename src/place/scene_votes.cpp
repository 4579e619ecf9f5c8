#include "scene_votes.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace semantic_mht_slam {
namespace {

constexpr double kMinLength_m = 3.0;
constexpr double kMaxLength_m = 45.0;
constexpr double kMaxStddev_m = 0.9;  // of an object that votes: others give no heading
constexpr std::size_t kMaxVoters = 44;
constexpr double kCell_m = 1.5;
constexpr int kYawCells = 72;
constexpr double kYawStep_rad = 2.0 * M_PI / kYawCells;

/// A pair of objects, directed from the lower class to the higher.
struct SegmentOfScene {
  int class_pair = 0;
  double length_m = 0.0;
  double heading_rad = 0.0;
  double stddev_m = 0.0;
  Eigen::Vector2d along = Eigen::Vector2d::UnitX();  // direction
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
                        std::sqrt(a.variance_m2 + b.variance_m2), along_m / length_m,
                        0.5 * (a.position_m + b.position_m), a.class_index != b.class_index});
    }
  }
  std::sort(result.begin(), result.end(), [](const SegmentOfScene& a, const SegmentOfScene& b) {
    return a.class_pair != b.class_pair ? a.class_pair < b.class_pair : a.length_m < b.length_m;
  });
  return result;
}

/// What one cell got.
struct CellVotes {
  float weight = 0.0F;
  float x_m = 0.0F;
  float y_m = 0.0F;
  float yaw_rad = 0.0F;  // relative to the middle of the cell
};

/// A heading and where it takes the origin of the query, in the frame of the match.
struct Motion {
  double yaw_rad = 0.0;
  Eigen::Vector2d offset_m = Eigen::Vector2d::Zero();
  double votes = 0.0;
};

/// Votes over heading and offset.
class VoteSheet {
 public:
  explicit VoteSheet(double max_offset_m)
      : max_offset_m_(max_offset_m),
        side_(2 * static_cast<int>(std::ceil(max_offset_m / kCell_m))),
        cells_(static_cast<std::size_t>(kYawCells) * side_ * side_) {}

  void add(double yaw_rad, const Eigen::Vector2d& offset_m, double weight) {
    if (offset_m.squaredNorm() > max_offset_m_ * max_offset_m_) return;
    const double turn = yaw_rad / (2.0 * M_PI);
    const double yaw_place = (turn - std::floor(turn)) * kYawCells;
    const int yaw = std::min(kYawCells - 1, static_cast<int>(yaw_place));
    const int x = std::clamp(static_cast<int>(std::floor(offset_m.x() / kCell_m)) + side_ / 2, 0, side_ - 1);
    const int y = std::clamp(static_cast<int>(std::floor(offset_m.y() / kCell_m)) + side_ / 2, 0, side_ - 1);
    CellVotes& cell = cells_[indexOf(yaw, x, y)];
    cell.weight += static_cast<float>(weight);
    cell.x_m += static_cast<float>(weight * offset_m.x());
    cell.y_m += static_cast<float>(weight * offset_m.y());
    cell.yaw_rad += static_cast<float>(weight * (yaw_place - yaw - 0.5) * kYawStep_rad);
  }

  std::vector<Motion> peaks(int count) const {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      if (cells_[i].weight > 0.0F) order.push_back(i);
    }
    const std::size_t kept = std::min(order.size(), static_cast<std::size_t>(kCellsPerPeak * count));
    std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(kept), order.end(),
                      [this](std::size_t a, std::size_t b) {
                        return cells_[a].weight != cells_[b].weight ? cells_[a].weight > cells_[b].weight : a < b;
                      });
    order.resize(kept);
    std::vector<Motion> motions;
    for (const std::size_t i : order) motions.push_back(around(i));
    std::stable_sort(motions.begin(), motions.end(),
                     [](const Motion& a, const Motion& b) { return a.votes > b.votes; });
    return distinct(motions, count);
  }

 private:
  static constexpr int kCellsPerPeak = 6;

  std::size_t indexOf(int yaw, int x, int y) const { return (static_cast<std::size_t>(yaw) * side_ + x) * side_ + y; }

  /// Mean over a cell and its neighbours.
  Motion around(std::size_t index) const {
    const int yaw = static_cast<int>(index) / (side_ * side_);
    const int x = static_cast<int>(index) / side_ % side_;
    const int y = static_cast<int>(index) % side_;
    Motion motion;
    double yaw_rad = 0.0;
    for (int turn = -1; turn <= 1; ++turn) {
      const int yaw_cell = (yaw + turn + kYawCells) % kYawCells;
      for (int nx = std::max(0, x - 1); nx <= std::min(side_ - 1, x + 1); ++nx) {
        for (int ny = std::max(0, y - 1); ny <= std::min(side_ - 1, y + 1); ++ny) {
          const CellVotes& cell = cells_[indexOf(yaw_cell, nx, ny)];
          const double weight = static_cast<double>(cell.weight);
          motion.votes += weight;
          motion.offset_m += Eigen::Vector2d(static_cast<double>(cell.x_m), static_cast<double>(cell.y_m));
          yaw_rad += static_cast<double>(cell.yaw_rad) + weight * turn * kYawStep_rad;
        }
      }
    }
    motion.offset_m /= motion.votes;
    motion.yaw_rad = (yaw + 0.5) * kYawStep_rad + yaw_rad / motion.votes;
    return motion;
  }

  static std::vector<Motion> distinct(const std::vector<Motion>& motions, int count) {
    std::vector<Motion> result;
    for (const Motion& motion : motions) {
      const bool is_near = std::any_of(result.begin(), result.end(), [&](const Motion& other) {
        return (motion.offset_m - other.offset_m).squaredNorm() < kCell_m * kCell_m &&
               std::cos(motion.yaw_rad - other.yaw_rad) > std::cos(kYawStep_rad);
      });
      if (!is_near) result.push_back(motion);
      if (static_cast<int>(result.size()) == count) break;
    }
    return result;
  }

  double max_offset_m_;
  int side_;
  std::vector<CellVotes> cells_;
};

void vote(const SegmentOfScene& query, const SegmentOfScene& match, double tolerance_m, VoteSheet& sheet) {
  const double weight = 1.0 / (0.3 + tolerance_m);
  const double along = query.along.dot(match.along);  // of unit vectors: cosine and sine of the turn between them
  const double across = query.along.x() * match.along.y() - query.along.y() * match.along.x();
  for (int way = 0; way < (query.is_directed ? 1 : 2); ++way) {
    Eigen::Matrix2d rotation;
    rotation << along, -across, across, along;
    if (way == 1) rotation = -rotation;
    const Eigen::Vector2d offset_m = match.middle_m - rotation * query.middle_m;
    sheet.add(match.heading_rad - query.heading_rad + way * M_PI, offset_m, weight);
  }
}

PlanarGuess aboutCentres(const Motion& motion, const PlanarScene& query, const PlanarScene& match) {
  PlanarGuess guess;
  guess.yaw_rad = motion.yaw_rad;
  guess.shift_m = motion.offset_m + Eigen::Rotation2Dd(motion.yaw_rad) * query.centre_m - match.centre_m;
  guess.votes = motion.votes;
  return guess;
}

}  // namespace

std::vector<PlanarGuess> voteForMotions(const PlanarScene& query, const PlanarScene& match, double max_offset_m,
                                        int count) {
  const std::vector<SegmentOfScene> of_query = segments(query);
  const std::vector<SegmentOfScene> of_match = segments(match);
  VoteSheet sheet(max_offset_m);
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
      if (other.length_m >= segment.length_m - tolerance_m) vote(segment, other, tolerance_m, sheet);
    }
  }
  std::vector<PlanarGuess> guesses;
  for (const Motion& motion : sheet.peaks(count)) guesses.push_back(aboutCentres(motion, query, match));
  return guesses;
}

}  // namespace semantic_mht_slam
