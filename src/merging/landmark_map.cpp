#include "semantic_mht_slam/merging/landmark_map.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/slam/slam_parts_state.h"

namespace semantic_mht_slam {
namespace {

constexpr std::size_t kInView = 25;   // landmarks that the vehicle would see
constexpr double kNoiseShare = 0.01;  // deviation of a landmark by the range
constexpr double kRigid_m = 1e-3;     // of the way between keyframes
constexpr double kRigid_rad = 1e-5;

double distance(const BareLandmark& a, const BareLandmark& b) {
  return (a.position_m - b.position_m).head<2>().norm();
}

double medianOf(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

/// Within which a landmark has `kInView` others, or half of them if they are few.
double rangeOf(const std::vector<BareLandmark>& landmarks) {
  const std::size_t rank = std::min(kInView, (landmarks.size() - 1) / 2);
  std::vector<double> reach_m;
  for (const BareLandmark& landmark : landmarks) {
    std::vector<double> distances;
    for (const BareLandmark& other : landmarks) distances.push_back(distance(landmark, other));
    std::sort(distances.begin(), distances.end());
    reach_m.push_back(distances[rank]);
  }
  return std::max(1e-3, medianOf(std::move(reach_m)));
}

/// Places from which all landmarks are seen, each near the one before.
std::vector<Pose> viewpoints(const std::vector<BareLandmark>& landmarks, double range_m) {
  std::vector<bool> is_covered(landmarks.size(), false);
  std::vector<Pose> open;
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    if (is_covered[i]) continue;
    std::vector<double> heights_m;
    for (std::size_t k = 0; k < landmarks.size(); ++k) {
      const double distance_m = distance(landmarks[i], landmarks[k]);
      if (distance_m < 0.5 * range_m) is_covered[k] = true;
      if (distance_m < range_m) heights_m.push_back(landmarks[k].position_m.z());
    }
    Pose pose;
    pose.translation_m = landmarks[i].position_m;
    pose.translation_m.z() = medianOf(std::move(heights_m));
    open.push_back(pose);
  }
  std::vector<Pose> tour;
  while (!open.empty()) {
    auto next = open.begin();
    for (auto pose = open.begin(); pose != open.end() && !tour.empty(); ++pose) {
      const Eigen::Vector3d& at_m = tour.back().translation_m;
      if ((pose->translation_m - at_m).norm() < (next->translation_m - at_m).norm()) next = pose;
    }
    tour.push_back(*next);
    open.erase(next);
  }
  return tour;
}

Submap makeSubmap(const std::vector<BareLandmark>& landmarks, const Pose& T_map_submap, double noise_m, int classes) {
  Submap submap;
  submap.id = SubmapId(0);
  submap.T_odom_submap = T_map_submap;
  const Pose T_submap_map = T_map_submap.inverse();
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    MixtureLandmark landmark;
    landmark.id = i + 1;
    landmark.position = {T_submap_map * landmarks[i].position_m, noise_m * noise_m * Eigen::Matrix3d::Identity()};
    landmark.components.push_back({1.0, landmark.position});
    landmark.class_probs = ClassProbs::Zero(classes);
    landmark.class_probs(landmarks[i].class_index) = 1.0;
    landmark.existence_prob = 1.0;
    landmark.observations = 1;
    landmark.first_submap = landmark.last_submap = submap.id;
    submap.landmarks.push_back(std::move(landmark));
    submap.associations.push_back({0, static_cast<int>(i), i + 1});  // side by side: none of them is another one
  }
  return submap;
}

}  // namespace

SlamParts makeLandmarkMap(const std::vector<BareLandmark>& landmarks, const SlamConfig& config,
                          const ClassTable& classes) {
  if (landmarks.size() < 3) throw InputError("a map of less than three landmarks");
  const double range_m = rangeOf(landmarks);
  const double factor = range_m / Length::kReferenceRange_m;
  const SlamConfig fitted = fittedTo(config, factor);
  SlamParts parts = makeParts(fitted, classes);
  parts.range_factor = factor;
  parts.is_fitted = true;
  fitParts(fitted, classes, parts);
  const std::vector<Pose> views = viewpoints(landmarks, range_m);
  const Submap submap = makeSubmap(landmarks, views.front(), kNoiseShare * range_m, classes.size());
  std::vector<Keyframe> keyframes;
  std::vector<PoseNode> nodes;
  double driven_m = 0.0;
  for (std::size_t v = 0; v < views.size(); ++v) {
    const Pose T_previous_view = (v == 0 ? Pose::identity() : views[v - 1].inverse()) * views[v];
    if (v > 0) driven_m += T_previous_view.translation_m.norm();
    Keyframe keyframe{v, submap.id, driven_m, {}, 0, views[v], 0.0};
    PoseNode node;
    node.T_previous_node = T_previous_view;
    node.T_world_node = views[v];
    node.odometry_cov.setZero();
    node.odometry_cov.diagonal().head<3>().setConstant(kRigid_m * kRigid_m);
    node.odometry_cov.diagonal().tail<3>().setConstant(kRigid_rad * kRigid_rad);
    for (const MixtureLandmark& landmark : submap.landmarks) {
      const SceneObject object = sceneObject(landmark, views[v].inverse() * submap.T_odom_submap, 0.0);
      if (object.position_m.head<2>().norm() > range_m) continue;
      keyframe.scene.objects.push_back(object);
      if (classes[object.class_index].is_static && classes[object.class_index].transition == Transition::kDirac) {
        node.sightings.push_back({static_cast<std::int64_t>(landmark.id), object.position_m, symmetric(object.cov_m2)});
      }
    }
    keyframes.push_back(std::move(keyframe));
    nodes.push_back(std::move(node));
  }
  parts.map.add(std::make_shared<const Submap>(submap), std::move(keyframes));
  for (const PoseNode& node : nodes) parts.graph.add(node);
  parts.map.apply({views, {}, ""});
  return parts;
}

}  // namespace semantic_mht_slam
