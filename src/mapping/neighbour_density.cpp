#include "semantic_mht_slam/mapping/neighbour_density.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace semantic_mht_slam {
namespace {

constexpr double kFirstRing_m = 0.05;
constexpr double kRingRatio = 1.5;  // 16 rings reach 22 m
constexpr double kLeastHeightStddev_m = 0.05;

using FramesOf = std::map<LandmarkId, std::vector<std::size_t>>;  ///< that showed each landmark, rising

std::size_t ringOf(double distance_m) {
  if (distance_m < kFirstRing_m) return 0;
  return 1 + static_cast<std::size_t>(std::log(distance_m / kFirstRing_m) / std::log(kRingRatio));
}

double outerRadius(std::size_t ring) {
  return kFirstRing_m * std::pow(kRingRatio, static_cast<double>(ring));
}

double ringArea(std::size_t ring) {
  const double outer_m = outerRadius(ring);
  const double inner_m = ring == 0 ? 0.0 : outerRadius(ring - 1);
  return M_PI * (outer_m * outer_m - inner_m * inner_m);
}

double planarDistance(const MixtureLandmark& a, const MixtureLandmark& b) {
  return (a.position.mean_m - b.position.mean_m).head<2>().norm();
}

FramesOf framesOf(const std::vector<DetectionAssociation>& associations) {
  FramesOf frames_of;
  for (const DetectionAssociation& association : associations) {
    if (association.landmark == kNoLandmark) continue;
    std::vector<std::size_t>& frames = frames_of[association.landmark];
    if (frames.empty() || frames.back() != association.frame) frames.push_back(association.frame);
  }
  return frames_of;
}

}  // namespace

NeighbourDensity::NeighbourDensity(int class_count, double reach_m)
    : reach_m_(reach_m), of_class_(static_cast<std::size_t>(class_count)) {}

/// By powers of two; the last bin has all that is beyond.
std::size_t NeighbourDensity::binOf(int looks) {
  return std::min(kLookBins - 1, static_cast<std::size_t>(std::log2(looks + 1.0)));
}

void NeighbourDensity::add(SubmapId submap, const std::vector<MixtureLandmark>& landmarks,
                           const std::vector<DetectionAssociation>& associations) {
  const FramesOf frames_of = framesOf(associations);
  for (const MixtureLandmark& of : landmarks) {
    const ClassIndex class_index = of.mostLikelyClass();
    Neighbours& neighbours = of_class_[static_cast<std::size_t>(class_index)];
    neighbours.objects += of.existence_prob;
    const auto looks = frames_of.find(of.id);
    for (const MixtureLandmark& other : landmarks) {
      if (other.id == of.id || other.mostLikelyClass() != class_index) continue;
      addPair(of, other, neighbours);
      const auto seen = frames_of.find(other.id);
      const bool is_new = other.first_submap == submap && seen != frames_of.end();
      if (!is_new || looks == frames_of.end() || planarDistance(of, other) > reach_m_) continue;
      const int looks_before = std::max(0, of.observations - static_cast<int>(looks->second.size()));
      const double exist = of.existence_prob * other.existence_prob;
      addLooks(looks->second, looks_before, seen->second.front(), exist, neighbours);
    }
  }
}

void NeighbourDensity::addPair(const MixtureLandmark& of, const MixtureLandmark& other, Neighbours& neighbours) {
  const std::size_t ring = ringOf(planarDistance(of, other));
  if (ring >= kRings) return;
  const double exist = of.existence_prob * other.existence_prob;
  const double height_m = other.position.mean_m.z() - of.position.mean_m.z();
  neighbours.pairs[ring] += exist;
  neighbours.all_pairs += exist;
  neighbours.height_squares_m2 += exist * height_m * height_m;
}

/// Frames that showed an object, rising, and the first that showed its neighbour.
void NeighbourDensity::addLooks(const std::vector<std::size_t>& frames, int looks_before, std::size_t first_of_other,
                                double exist, Neighbours& neighbours) {
  const auto first = std::lower_bound(frames.begin(), frames.end(), first_of_other);
  const auto looks_without = static_cast<int>(first - frames.begin());
  for (int look = 0; look < looks_without; ++look) neighbours.looks[binOf(looks_before + look)] += exist;
  if (looks_without == 0 || first == frames.end()) return;
  neighbours.looks[binOf(looks_before + looks_without)] += exist;
  neighbours.first[binOf(looks_before + looks_without)] += exist;
}

double NeighbourDensity::logFirstProb(ClassIndex class_index, int looks) const {
  const Neighbours& neighbours = of_class_[static_cast<std::size_t>(class_index)];
  const std::size_t bin = binOf(looks);
  const double prior = 1.0 / ((looks + 1.0) * (looks + 2.0));  // mean of p (1 - p)^looks, any p as likely
  return std::log((neighbours.first[bin] + prior) / (neighbours.looks[bin] + 1.0));
}

double NeighbourDensity::logDensity(ClassIndex class_index, const Eigen::Vector3d& offset_m) const {
  const Neighbours& neighbours = of_class_[static_cast<std::size_t>(class_index)];
  const std::size_t ring = ringOf(offset_m.head<2>().norm());
  if (ring >= kRings || neighbours.pairs[ring] <= 0.0) return -std::numeric_limits<double>::infinity();
  const double variance_m2 =
      kLeastHeightStddev_m * kLeastHeightStddev_m + neighbours.height_squares_m2 / neighbours.all_pairs;
  const double log_planar = std::log(neighbours.pairs[ring] / (neighbours.objects * ringArea(ring)));
  return log_planar - 0.5 * (offset_m.z() * offset_m.z() / variance_m2 + std::log(2.0 * M_PI * variance_m2));
}

}  // namespace semantic_mht_slam
