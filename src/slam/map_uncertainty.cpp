#include "semantic_mht_slam/slam/map_uncertainty.h"

#include "semantic_mht_slam/common/gaussian.h"

namespace semantic_mht_slam {
namespace {

constexpr double kGaugeStddev_m = 1e-3;
constexpr double kGaugeStddev_rad = 1e-5;

Eigen::Vector3d leverFrom(const Map& map, KeyframeId from, const Eigen::Vector3d& position_m) {
  return position_m - map.T_map_keyframe(from).translation_m;
}

/// What the gauge adds to whatever is at a place.
FixedAxesCov shareOf(const MapGauge& gauge, const Map& map, const Eigen::Vector3d& position_m) {
  const Eigen::Vector3d way_m = leverFrom(map, KeyframeId(0), position_m);
  FixedAxesCov cov = carried(gauge.start_cov, way_m);
  cov.topLeftCorner<3, 3>() += gauge.scale_stddev * gauge.scale_stddev * way_m * way_m.transpose();
  return cov;
}

FixedAxesCov shareOf(const MapGauge& gauge, const Map& map, KeyframeId keyframe) {
  return shareOf(gauge, map, map.T_map_keyframe(keyframe).translation_m);
}

FixedAxesCov carriedTo(const Map& map, KeyframeId keyframe, const NodeMarginal& marginal) {
  const KeyframeId from(static_cast<std::size_t>(marginal.node));
  return carried(inFixedAxes(map.T_map_keyframe(from), marginal.total()),
                 leverFrom(map, from, map.T_map_keyframe(keyframe).translation_m));
}

}  // namespace

FixedAxesCov gaugeCov() {
  FixedAxesCov cov = FixedAxesCov::Zero();
  cov.diagonal().head<3>().setConstant(kGaugeStddev_m * kGaugeStddev_m);
  cov.diagonal().tail<3>().setConstant(kGaugeStddev_rad * kGaugeStddev_rad);
  return cov;
}

MapUncertainty uncertaintyOf(const Map& map, const MapGraph& graph, const MapGauge& gauge) {
  const std::optional<GraphMarginals> marginals = graph.marginals();
  if (!marginals) return coarseUncertaintyOf(map, graph, gauge);
  MapUncertainty result;
  for (const KeyframeId keyframe : map.keyframes().ids()) {
    result.keyframes.push_back(inFixedAxes(map.T_map_keyframe(keyframe), marginals->poses[keyframe.index()]) +
                               shareOf(gauge, map, keyframe));
  }
  for (const auto& [name, cov_m2] : marginals->landmarks) {
    const auto id = static_cast<LandmarkId>(name);
    result.landmarks[id] = symmetric(cov_m2 + shareOf(gauge, map, *graph.landmark(id)).topLeftCorner<3, 3>());
  }
  return result;
}

MapUncertainty coarseUncertaintyOf(const Map& map, const MapGraph& graph, const MapGauge& gauge) {
  const std::optional<std::vector<NodeMarginal>> marginals = graph.coarseMarginals();
  MapUncertainty result;
  std::size_t next = 0;  // marginal behind the keyframe
  for (const KeyframeId keyframe : map.keyframes().ids()) {
    if (!marginals) {
      result.keyframes.push_back(unknownPoseCov());
      continue;
    }
    const auto node = static_cast<int>(keyframe.index());
    while (next < marginals->size() && (*marginals)[next].node <= node) ++next;
    const NodeMarginal& before = (*marginals)[next - 1];
    FixedAxesCov cov = carriedTo(map, keyframe, before);
    if (before.node != node) {
      // The mean of both ends' covariances holds the part that the two do not share: it stands for the way between.
      const NodeMarginal& after = (*marginals)[next];
      const double fraction = static_cast<double>(node - before.node) / (after.node - before.node);
      cov = (1.0 - fraction) * cov + fraction * carriedTo(map, keyframe, after);
    }
    result.keyframes.push_back(symmetric(cov + shareOf(gauge, map, keyframe)));
  }
  return result;
}

UncertainPose newestKeyframe(const Map& map, const MapGraph& graph, const MapGauge& gauge) {
  const KeyframeId newest(map.keyframes().size() - 1);
  const Pose& T_map_keyframe = map.T_map_keyframe(newest);
  const std::optional<std::vector<NodeMarginal>> marginals = graph.coarseMarginals();
  if (!marginals) return {T_map_keyframe, unknownPoseCov()};
  const NodeMarginal& marginal = marginals->back();
  const FixedAxesCov cov = inFixedAxes(T_map_keyframe, marginal.cov) + shareOf({gauge.start_cov, 0.0}, map, newest);
  SharedErrors shared = inFixedAxes(T_map_keyframe, marginal.shared);
  shared.col(0).head<3>() += gauge.scale_stddev * leverFrom(map, KeyframeId(0), T_map_keyframe.translation_m);
  return {T_map_keyframe, symmetric(cov), shared};
}

}  // namespace semantic_mht_slam
