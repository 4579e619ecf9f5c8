#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "semantic_mht_slam/map/landmark.h"

#include "first_guesses.h"
#include "vote_grid.h"

namespace semantic_mht_slam {
namespace {

constexpr double kMinLength_m = 3.0;
constexpr double kMaxLength_m = 45.0;
constexpr double kMaxStddev_m = 0.9;  // of a point that votes: others give no heading
constexpr std::size_t kMaxVoters = 44;
constexpr double kLengthToleranceSigmas = 1.5;
constexpr double kWidest_m = 2.0 * kLengthToleranceSigmas * kMaxStddev_m;
constexpr double kSharpest_m = 0.3;  // added to the tolerance of a pair: the finest votes are not much finer than that

/// Two points, directed from the lower class to the higher.
struct Segment {
  int class_pair = 0;
  double length_m = 0.0;
  double heading_rad = 0.0;
  double variance_m2 = 0.0;                          ///< of both ends
  Eigen::Vector2d along = Eigen::Vector2d::UnitX();  ///< direction
  Eigen::Vector2d middle_m = Eigen::Vector2d::Zero();
  bool is_directed = true;  ///< false: both ends have one class
};

struct Voter {
  const LevelledPoint* point;
  double variance_m2;
};

/// The points that are found again most sharply, by class. A pair of class c errs by `extra_variance_m2[c]` besides
/// what `points` say.
std::vector<Voter> voters(const std::vector<LevelledPoint>& points, const std::vector<double>& extra_variance_m2) {
  const auto pairVariance = [&](const Voter& voter) {
    return voter.variance_m2 + extra_variance_m2[voter.point->class_index];
  };
  std::vector<Voter> result;
  for (const LevelledPoint& point : points) {
    const Voter voter{&point, 0.5 * (point.cov_m2(0, 0) + point.cov_m2(1, 1))};
    if (pairVariance(voter) < kMaxStddev_m * kMaxStddev_m) result.push_back(voter);
  }
  if (result.size() > kMaxVoters) {
    std::stable_sort(result.begin(), result.end(),
                     [&](const Voter& a, const Voter& b) { return pairVariance(a) < pairVariance(b); });
    result.resize(kMaxVoters);
    std::sort(result.begin(), result.end(), [](const Voter& a, const Voter& b) { return a.point < b.point; });
  }
  return result;
}

std::vector<Segment> segments(const std::vector<LevelledPoint>& points, const std::vector<double>& extra_variance_m2) {
  const std::vector<Voter> ends = voters(points, extra_variance_m2);
  std::vector<Segment> result;
  result.reserve(ends.size() * ends.size() / 2);
  for (std::size_t i = 0; i < ends.size(); ++i) {
    for (std::size_t k = i + 1; k < ends.size(); ++k) {
      const LevelledPoint& a = *ends[i].point;
      const LevelledPoint& b = *ends[k].point;
      const Eigen::Vector2d along_m = (b.position_m - a.position_m).head<2>();
      const double length_m = along_m.norm();
      if (length_m < kMinLength_m || length_m > kMaxLength_m) continue;
      result.push_back({a.class_index * kMaxClasses + b.class_index, length_m, std::atan2(along_m.y(), along_m.x()),
                        ends[i].variance_m2 + ends[k].variance_m2, along_m / length_m,
                        0.5 * (a.position_m + b.position_m).head<2>(), a.class_index != b.class_index});
    }
  }
  std::sort(result.begin(), result.end(), [](const Segment& a, const Segment& b) {
    return a.class_pair != b.class_pair ? a.class_pair < b.class_pair : a.length_m < b.length_m;
  });
  return result;
}

/// A vote that is shared out between two neighbouring layers.
struct PairVote {
  Eigen::Vector2d at_m;
  double in_first = 0.0;
  double in_second = 0.0;
  std::ptrdiff_t next = -1;  ///< vote with the same first layer
};

/// The votes by the first of their layers. Their order does not matter: what is summed up are integers.
class VotesByLayer {
 public:
  using Index = std::ptrdiff_t;

  VotesByLayer(const RegistrationProblem& problem, const VoteGrid& grid)
      : max_offset_m_(problem.prior.window(0)), newest_(grid.layers(), -1) {}

  void add(const Segment& detections, const Segment& landmarks, double tolerance_m) {
    const double weight = 1.0 / (kSharpest_m + tolerance_m);
    const double along = detections.along.dot(landmarks.along);  // cosine and sine of the turn between them
    const double across = detections.along.x() * landmarks.along.y() - detections.along.y() * landmarks.along.x();
    for (int way = 0; way < (detections.is_directed ? 1 : 2); ++way) {
      Eigen::Matrix2d rotation;
      rotation << along, -across, across, along;
      if (way == 1) rotation = -rotation;
      const Eigen::Vector2d offset_m = landmarks.middle_m - rotation * detections.middle_m;
      if (offset_m.squaredNorm() > max_offset_m_ * max_offset_m_) continue;
      const double turns = (landmarks.heading_rad - detections.heading_rad) / (2.0 * M_PI) + 0.5 * way + 0.5;
      const double place = (turns - std::floor(turns)) * static_cast<double>(newest_.size());
      const std::size_t first = std::min(newest_.size() - 1, static_cast<std::size_t>(place));
      const double part = place - static_cast<double>(first);
      const Index index = votes_.size();
      votes_.push_back({offset_m, weight * (1.0 - part), weight * part, newest_[first]});
      newest_[first] = index;
    }
  }

  void cast(int layer, VoteGrid& grid) const {
    for (Index v = newest_[layer]; v >= 0; v = votes_[v].next) grid.addShared(votes_[v].at_m, votes_[v].in_first);
    for (Index v = newest_[(layer + newest_.size() - 1) % newest_.size()]; v >= 0; v = votes_[v].next) {
      grid.addShared(votes_[v].at_m, votes_[v].in_second);
    }
  }

 private:
  double max_offset_m_;
  std::vector<PairVote> votes_;
  std::vector<Index> newest_;  ///< of each first layer; -1: none
};

}  // namespace

std::vector<PlanarState> guessByPairs(const RegistrationProblem& problem, int count) {
  const std::vector<Segment> of_detections = segments(problem.detections, problem.extra_variance_m2);
  const std::vector<Segment> of_landmarks =
      segments(problem.landmarks, std::vector<double>(problem.is_static.size(), 0.0));
  VoteGrid grid(problem);
  VotesByLayer votes(problem, grid);
  std::size_t begin = 0;
  for (const Segment& segment : of_detections) {
    while (begin < of_landmarks.size() && (of_landmarks[begin].class_pair < segment.class_pair ||
                                           (of_landmarks[begin].class_pair == segment.class_pair &&
                                            of_landmarks[begin].length_m < segment.length_m - kWidest_m))) {
      ++begin;
    }
    for (std::size_t i = begin; i < of_landmarks.size(); ++i) {
      const Segment& other = of_landmarks[i];
      if (other.class_pair != segment.class_pair || other.length_m > segment.length_m + kWidest_m) break;
      const double tolerance_m = kLengthToleranceSigmas * std::sqrt(segment.variance_m2 + other.variance_m2);
      if (std::abs(other.length_m - segment.length_m) <= tolerance_m) votes.add(segment, other, tolerance_m);
    }
  }
  return grid.peaks(count, [&](int layer) { votes.cast(layer, grid); });
}

}  // namespace semantic_mht_slam
