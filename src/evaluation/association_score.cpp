#include "semantic_mht_slam/evaluation/association_score.h"

#include <algorithm>
#include <array>
#include <map>
#include <stdexcept>
#include <string>

#include "semantic_mht_slam/evaluation/statistics.h"

namespace semantic_mht_slam {
namespace {

constexpr std::int64_t kWindowFrames = 300;
constexpr std::int64_t kClutter = -1;
constexpr std::int64_t kFalsePositive = -1;

using LandmarksOfFrame = std::map<std::int64_t, std::vector<std::int64_t>>;

/// A detection of a static object; two detections can only be a pair inside the same window.
struct Assignment {
  std::int64_t window = 0;
  std::int64_t truth = 0;
  std::int64_t estimate = 0;
};

/// Number of pairs of equal keys.
template <std::size_t N>
std::int64_t equalPairs(std::vector<std::array<std::int64_t, N>> keys) {
  std::sort(keys.begin(), keys.end());
  std::int64_t pairs = 0;
  for (auto begin = keys.begin(); begin != keys.end();) {
    const auto end = std::upper_bound(begin, keys.end(), *begin);
    const std::int64_t count = end - begin;
    pairs += count * (count - 1) / 2;
    begin = end;
  }
  return pairs;
}

PairwiseScore pairwiseScore(const std::vector<Assignment>& assignments) {
  std::vector<std::array<std::int64_t, 3>> both;
  std::vector<std::array<std::int64_t, 2>> truth;
  std::vector<std::array<std::int64_t, 2>> estimate;
  for (const Assignment& a : assignments) {
    both.push_back({a.window, a.truth, a.estimate});
    truth.push_back({a.window, a.truth});
    estimate.push_back({a.window, a.estimate});
  }
  const std::int64_t right = equalPairs(both);
  PairwiseScore score;
  score.precision = share(right, equalPairs(estimate));
  score.recall = share(right, equalPairs(truth));
  score.f1 = 2.0 * score.precision * score.recall / std::max(1e-12, score.precision + score.recall);
  return score;
}

[[noreturn]] void fail(const AssociatedDetection& detection, const std::string& problem) {
  throw std::invalid_argument("frame " + std::to_string(detection.frame) + ", row " + std::to_string(detection.row) +
                              ": " + problem);
}

std::int64_t trueLandmark(const LandmarksOfFrame& truth, const AssociatedDetection& detection) {
  const auto frame = truth.find(detection.frame);
  const auto rows = frame == truth.end() ? 0 : static_cast<std::int64_t>(frame->second.size());
  if (detection.row < 0 || detection.row >= rows) {
    fail(detection, "the truth has " + std::to_string(rows) + " detections in this frame");
  }
  return frame->second[static_cast<std::size_t>(detection.row)];
}

void requireUsable(const std::vector<AssociatedDetection>& associations) {
  std::vector<std::array<std::int64_t, 2>> places;
  for (const AssociatedDetection& detection : associations) {
    if (detection.landmark < kFalsePositive) {
      fail(detection, "no landmark has the number " + std::to_string(detection.landmark));
    }
    places.push_back({detection.frame, detection.row});
  }
  std::sort(places.begin(), places.end());
  const auto twice = std::adjacent_find(places.begin(), places.end());
  if (twice != places.end()) fail({(*twice)[0], (*twice)[1], 0}, "stands twice");
}

}  // namespace

AssociationScore associationScore(const std::vector<TrueDetection>& truth,
                                  const std::vector<AssociatedDetection>& associations) {
  requireUsable(associations);
  LandmarksOfFrame landmarks;
  for (const TrueDetection& detection : truth) landmarks[detection.frame].push_back(detection.landmark);

  std::vector<Assignment> assignments;
  std::int64_t clutter = 0;
  std::int64_t accepted_clutter = 0;
  std::int64_t rejected = 0;
  for (const AssociatedDetection& detection : associations) {
    const std::int64_t true_landmark = trueLandmark(landmarks, detection);
    const bool is_rejected = detection.landmark == kFalsePositive;
    if (true_landmark == kClutter) {
      ++clutter;
      accepted_clutter += is_rejected ? 0 : 1;
    }
    if (true_landmark < 0) continue;
    if (is_rejected) ++rejected;
    const std::int64_t estimate = is_rejected ? -rejected : detection.landmark;
    assignments.push_back({detection.frame / kWindowFrames, true_landmark, estimate});
  }

  AssociationScore score;
  score.local = pairwiseScore(assignments);
  score.scored_detections = static_cast<std::int64_t>(associations.size());
  score.true_detections = static_cast<std::int64_t>(truth.size());
  score.clutter_accepted = share(accepted_clutter, clutter);
  score.static_rejected = share(rejected, static_cast<std::int64_t>(assignments.size()));
  for (Assignment& assignment : assignments) assignment.window = 0;
  score.all = pairwiseScore(assignments);
  return score;
}

}  // namespace semantic_mht_slam
