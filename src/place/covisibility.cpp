#include "semantic_mht_slam/place/covisibility.h"

#include <cmath>

namespace semantic_mht_slam {
namespace {

std::map<LandmarkId, const SceneObject*> landmarksOf(const Scene& scene) {
  std::map<LandmarkId, const SceneObject*> landmarks;
  for (const SceneObject& object : scene.objects) {
    if (object.landmark != kNoLandmark) landmarks.emplace(object.landmark, &object);
  }
  return landmarks;
}

}  // namespace

void describe(CovisibilityConfig& config, Fields& fields) {
  fields.add("distance_scale", config.distance_scale_m, "m", {0.1, 1000.0},
             "Standard deviation of the kernel that weighs two objects of a scene by their distance.");
}

double distanceKernel(double distance_m, const CovisibilityConfig& config) {
  const double ratio = distance_m / config.distance_scale_m;
  return std::exp(-0.5 * ratio * ratio);
}

void CovisibilityGraph::addKeyframe(const Scene& seen) {
  const auto landmarks = landmarksOf(seen);
  for (const auto& [id, object] : landmarks) {
    ++seen_[id];
    std::map<LandmarkId, Edge>& edges = edges_[id];
    for (const auto& [other_id, other] : landmarks) {
      if (other_id == id) continue;
      Edge& edge = edges[other_id];
      ++edge.together;
      edge.distance_sum_m += (object->position_m - other->position_m).norm();
    }
  }
}

int CovisibilityGraph::timesSeen(LandmarkId landmark) const {
  const auto found = seen_.find(landmark);
  return found == seen_.end() ? 0 : found->second;
}

int CovisibilityGraph::timesSeenTogether(LandmarkId a, LandmarkId b) const {
  const auto edges = edges_.find(a);
  if (edges == edges_.end()) return 0;
  const auto edge = edges->second.find(b);
  return edge == edges->second.end() ? 0 : edge->second.together;
}

double CovisibilityGraph::weightOf(LandmarkId a, LandmarkId b, const Edge& edge) const {
  const int either = timesSeen(a) + timesSeen(b) - edge.together;
  return distanceKernel(edge.distance_sum_m / edge.together, config_) * edge.together / either;
}

double CovisibilityGraph::weight(LandmarkId a, LandmarkId b) const {
  const auto of_a = edges_.find(a);
  if (of_a == edges_.end()) return 0.0;
  const auto edge = of_a->second.find(b);
  return edge == of_a->second.end() ? 0.0 : weightOf(a, b, edge->second);
}

std::vector<LandmarkId> CovisibilityGraph::neighbours(LandmarkId landmark, double min_weight) const {
  std::vector<LandmarkId> result;
  const auto edges = edges_.find(landmark);
  if (edges == edges_.end()) return result;
  for (const auto& [other, edge] : edges->second) {
    if (weightOf(landmark, other, edge) >= min_weight) result.push_back(other);
  }
  return result;
}

Scene CovisibilityGraph::sceneOf(const Scene& seen, const Scene& nearby, double min_weight) const {
  const auto landmarks = landmarksOf(seen);
  std::map<LandmarkId, std::size_t> votes;
  for (const auto& [id, object] : landmarks) {
    for (const LandmarkId neighbour : neighbours(id, min_weight)) ++votes[neighbour];
  }
  Scene scene = seen;
  for (const auto& [id, object] : landmarksOf(nearby)) {
    const auto vote = votes.find(id);
    const bool belongs = vote != votes.end() && 2 * vote->second >= landmarks.size();
    if (belongs && landmarks.count(id) == 0) scene.objects.push_back(*object);
  }
  return scene;
}

}  // namespace semantic_mht_slam
