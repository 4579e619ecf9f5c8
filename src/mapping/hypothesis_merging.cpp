#include "semantic_mht_slam/mapping/hypothesis_merging.h"

#include <algorithm>

#include "semantic_mht_slam/common/log_math.h"

namespace semantic_mht_slam {
namespace {

constexpr int kComparedFrames = 5;
constexpr double kTolerance = 0.1;  // of a landmark's standard deviation

bool areEqual(const TrackedLandmark& a, const TrackedLandmark& b) {
  if (a.id != b.id || a.earlier != b.earlier) return false;
  const Eigen::Vector3d d = a.position.mean_m - b.position.mean_m;
  const Eigen::Vector3d variance_m2 = a.position.cov_m2.diagonal();
  return (d.array().square() <= kTolerance * kTolerance * variance_m2.array()).all();
}

bool areEqual(const std::optional<PoseOffset>& a, const std::optional<PoseOffset>& b) {
  if (!a || !b) return !a && !b;
  const Eigen::Vector4d d = a->mean - b->mean;
  return (d.array().square() <= kTolerance * kTolerance * a->cov.diagonal().array()).all();
}

bool haveEqualHistory(const AssociationRecord* a, const AssociationRecord* b) {
  for (int i = 0; i < kComparedFrames; ++i) {
    if (a == b) return true;
    if (a == nullptr || b == nullptr || a->landmark_of_measurement != b->landmark_of_measurement) return false;
    a = a->previous.get();
    b = b->previous.get();
  }
  return true;
}

}  // namespace

bool areEqual(const MapHypothesis& a, const MapHypothesis& b) {
  if (!areEqual(a.map_offset, b.map_offset)) return false;
  if (a.landmarks.size() != b.landmarks.size()) return false;
  if (!haveEqualHistory(a.history.get(), b.history.get())) return false;
  for (std::size_t j = 0; j < a.landmarks.size(); ++j) {
    if (a.landmarks[j].tracked != b.landmarks[j].tracked && !areEqual(*a.landmarks[j], *b.landmarks[j])) return false;
  }
  return true;
}

void mergeEqualHypotheses(std::vector<MapHypothesis>& hypotheses) {
  std::vector<MapHypothesis> kept;
  for (MapHypothesis& hypothesis : hypotheses) {
    const auto same =
        std::find_if(kept.begin(), kept.end(), [&](const MapHypothesis& other) { return areEqual(other, hypothesis); });
    if (same == kept.end()) {
      kept.push_back(std::move(hypothesis));
    } else {
      same->log_weight = logAdd(same->log_weight, hypothesis.log_weight);
    }
  }
  hypotheses = std::move(kept);
}

}  // namespace semantic_mht_slam
