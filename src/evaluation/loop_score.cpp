#include "semantic_mht_slam/evaluation/loop_score.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>
#include <stdexcept>
#include <string>

#include "semantic_mht_slam/evaluation/planar_grid.h"
#include "semantic_mht_slam/evaluation/revisit.h"
#include "semantic_mht_slam/evaluation/statistics.h"

namespace semantic_mht_slam {
namespace {

constexpr double kRightWithin_m = 2.0;
constexpr std::int64_t kBlockFrames = 10;
constexpr std::int64_t kCoveredWithinBlocks = 10;
constexpr double kPositiveBelow_m = 3.0;
constexpr double kNegativeAbove_m = 20.0;

std::size_t checkedFrame(std::int64_t frame, std::size_t frames) {
  if (frame < 0 || static_cast<std::uint64_t>(frame) >= frames) {
    throw std::invalid_argument("frame " + std::to_string(frame) + " is none of the " + std::to_string(frames) +
                                " true poses");
  }
  return static_cast<std::size_t>(frame);
}

bool isRight(const std::vector<Pose>& T_world_base, const ClosureEstimate& closure) {
  if (!closure.query_in_match_m.allFinite()) throw std::invalid_argument("a loop closure that is not finite");
  const Pose& T_world_query = T_world_base[static_cast<std::size_t>(closure.query_frame)];
  const Pose& T_world_match = T_world_base[static_cast<std::size_t>(closure.match_frame)];
  const Eigen::Vector3d true_m = (T_world_match.inverse() * T_world_query).translation_m;
  return (true_m - closure.query_in_match_m).norm() < kRightWithin_m;
}

/// Blocks with a frame whose place was passed long before.
std::set<std::int64_t> revisitedBlocks(const std::vector<Pose>& T_world_base) {
  std::vector<Eigen::Vector2d> points_m;
  points_m.reserve(T_world_base.size());
  for (const Pose& pose : T_world_base) points_m.emplace_back(pose.translation_m.head<2>());
  const PlanarGrid grid(points_m, kRevisitRadius_m);
  std::set<std::int64_t> blocks;
  for (std::size_t i = 0; i < T_world_base.size(); ++i) {
    const bool is_revisit = grid.anyNear(points_m[i], [&](std::size_t j) {
      const Eigen::Vector3d step_m = T_world_base[i].translation_m - T_world_base[j].translation_m;
      return i > j + kRevisitMinFrames && step_m.norm() <= kRevisitRadius_m;
    });
    if (is_revisit) blocks.insert(static_cast<std::int64_t>(i) / kBlockFrames);
  }
  return blocks;
}

bool isCovered(std::int64_t block, const std::set<std::int64_t>& closed_blocks) {
  const auto nearest = closed_blocks.lower_bound(block - kCoveredWithinBlocks);
  return nearest != closed_blocks.end() && *nearest <= block + kCoveredWithinBlocks;
}

struct LabelledScore {
  double score = 0.0;
  bool positive = false;
};

/// The pairs that count, from the highest score to the lowest.
std::vector<LabelledScore> labelled(const std::vector<Eigen::Vector2d>& positions_m,
                                    const std::vector<PairEstimate>& pairs) {
  std::vector<LabelledScore> result;
  for (const PairEstimate& pair : pairs) {
    if (!std::isfinite(pair.score)) throw std::invalid_argument("a score that is not finite");
    const std::size_t i = checkedFrame(pair.i, positions_m.size());
    const std::size_t j = checkedFrame(pair.j, positions_m.size());
    const double distance_m = (positions_m[i] - positions_m[j]).norm();
    const bool positive = distance_m < kPositiveBelow_m;
    if (positive || distance_m > kNegativeAbove_m) result.push_back({pair.score, positive});
  }
  std::stable_sort(result.begin(), result.end(),
                   [](const LabelledScore& a, const LabelledScore& b) { return a.score > b.score; });
  return result;
}

/// Precision and recall at each distinct score: equal scores share one threshold.
void addCurve(const std::vector<LabelledScore>& scores, PairScore& result) {
  std::int64_t true_positives = 0;
  for (std::size_t i = 0; i < scores.size(); ++i) {
    true_positives += scores[i].positive ? 1 : 0;
    if (i + 1 < scores.size() && scores[i + 1].score == scores[i].score) continue;
    result.precision.push_back(share(true_positives, static_cast<std::int64_t>(i + 1)));
    result.recall.push_back(share(true_positives, result.positives));
  }
}

}  // namespace

ClosureScore closureScore(const std::vector<Pose>& T_world_base, const std::vector<ClosureEstimate>& closures) {
  ClosureScore score;
  std::set<std::int64_t> closed_blocks;
  for (const ClosureEstimate& closure : closures) {
    for (const std::int64_t frame : {closure.query_frame, closure.match_frame})
      checkedFrame(frame, T_world_base.size());
    if (!closure.accepted) continue;
    ++score.accepted;
    if (isRight(T_world_base, closure)) {
      closed_blocks.insert(closure.query_frame / kBlockFrames);
    } else {
      ++score.wrong;
    }
  }
  for (const std::int64_t block : revisitedBlocks(T_world_base)) {
    ++score.revisited_blocks;
    if (isCovered(block, closed_blocks)) ++score.covered_blocks;
  }
  score.precision = share(score.accepted - score.wrong, score.accepted);
  score.recall = share(score.covered_blocks, score.revisited_blocks);
  return score;
}

PairScore pairScore(const std::vector<Eigen::Vector2d>& positions_m, const std::vector<PairEstimate>& pairs) {
  const std::vector<LabelledScore> scores = labelled(positions_m, pairs);
  PairScore result;
  result.pairs = static_cast<std::int64_t>(scores.size());
  result.positives =
      std::count_if(scores.begin(), scores.end(), [](const LabelledScore& score) { return score.positive; });
  if (result.positives == 0) return result;
  addCurve(scores, result);
  result.f1_max = 0.0;
  result.recall_at_p100 = 0.0;
  for (std::size_t i = 0; i < result.precision.size(); ++i) {
    const double precision = result.precision[i];
    const double recall = result.recall[i];
    result.f1_max = std::max(result.f1_max, 2.0 * precision * recall / std::max(1e-12, precision + recall));
    if (precision == 1.0) result.recall_at_p100 = std::max(result.recall_at_p100, recall);
  }
  result.extended_precision = 0.5 * (result.precision.front() + result.recall_at_p100);
  return result;
}

}  // namespace semantic_mht_slam
