#include "semantic_mht_slam/slam/map_graph.h"

#include <algorithm>
#include <cstdint>
#include <stdexcept>

#include "semantic_mht_slam/common/state_archive.h"
#include "semantic_mht_slam/models/dead_reckoning.h"

namespace semantic_mht_slam {
namespace {

constexpr int kMoreSolutions = 3;         // after one that took closures back
constexpr double kSessionStddev_m = 1.0;  // of a pose by localization
constexpr double kSessionStddev_rad = 0.03;
constexpr double kLeastStep_m = 1e-3;  // of an edge between keyframes: one at a stop has an inverse, too
constexpr double kLeastStep_rad = 1e-5;

PoseCov poseCov(double stddev_m, double stddev_rad) {
  PoseCov cov = PoseCov::Zero();
  cov.diagonal().head<3>().setConstant(stddev_m * stddev_m);
  cov.diagonal().tail<3>().setConstant(stddev_rad * stddev_rad);
  return cov;
}

/// The node of a keyframe by odometry.
PoseNode odometryNode(const Map& map, KeyframeId id, const OdometryModel& odometry) {
  const Keyframe& keyframe = map.keyframes()[id];
  PoseNode node;
  if (id == KeyframeId(0)) {
    node.T_previous_node = keyframe.T_odom_base;
    return node;
  }
  const Keyframe& previous = map.keyframes()[KeyframeId(id.index() - 1)];
  const Pose T_previous_keyframe = previous.T_odom_base.inverse() * keyframe.T_odom_base;
  node.T_previous_node = expectedStep(odometry, T_previous_keyframe);
  node.odometry_cov = stepCovariance(odometry, motionTo(keyframe) - motionTo(previous), T_previous_keyframe);
  node.odometry_cov += poseCov(kLeastStep_m, kLeastStep_rad);
  node.shared_errors = sharedErrorsOf(odometry.systematic, T_previous_keyframe);
  return node;
}

}  // namespace

MapGraph::MapGraph(const BackEndConfig& config, const ClassTable& classes)
    : config_(config), classes_(classes), graph_(config.graph) {}

void MapGraph::add(const Map& map, IdRange<KeyframeId> keyframes, const std::vector<std::vector<Sighting>>& sightings,
                   const OdometryModel& odometry) {
  odometry_[map.keyframes()[keyframes.front()].submap] = odometry;
  auto seen = sightings.begin();
  for (const KeyframeId keyframe : keyframes) graph_.addNode(nodeOf(map, keyframe, *seen++, odometry));
}

PoseNode MapGraph::nodeOf(const Map& map, KeyframeId id, const std::vector<Sighting>& sightings,
                          const OdometryModel& odometry) {
  const Keyframe& keyframe = map.keyframes()[id];
  PoseNode node = odometryNode(map, id, odometry);
  if (T_map_odom_start_ && !map.T_map_keyframes().empty()) {
    node.T_previous_node = map.T_map_keyframes().back().inverse() * (*T_map_odom_start_ * keyframe.T_odom_base);
    node.odometry_cov = poseCov(kSessionStddev_m, kSessionStddev_rad);
    node.shared_errors.setZero();
  }
  T_map_odom_start_.reset();
  for (const Sighting& sighting : sightings) {
    const ClassInfo& info = classes_[sighting.class_index];
    if (!config_.landmark_factors || !info.is_static || info.transition != Transition::kDirac) continue;
    LandmarkSighting& seen = node.sightings.emplace_back();
    seen.landmark = sighting.landmark;
    seen.position_m = sighting.position_m;
    seen.cov_m2 = sighting.cov_m2;
  }
  return node;
}

bool MapGraph::beginsSession(KeyframeId keyframe) const {
  const PoseCov found = poseCov(kSessionStddev_m, kSessionStddev_rad);
  return keyframe != KeyframeId(0) && node(keyframe).odometry_cov.isApprox(found, 1e-9);
}

void MapGraph::add(const std::vector<OuterPosition>& positions) {
  for (const OuterPosition& position : positions) graph_.addPosition(position);
}

void MapGraph::removeClosure(ClosureId closure) {
  const auto factor = std::find(closure_of_factor_.begin(), closure_of_factor_.end(), closure);
  if (factor == closure_of_factor_.end()) throw std::invalid_argument("MapGraph: no closure of this graph");
  graph_.removeLoopClosure(static_cast<int>(factor - closure_of_factor_.begin()));
}

GraphUpdate MapGraph::review(const Map& map) {
  for (const ClosureId id : map.closures().idsFrom(next_closure_)) {
    const LoopClosureRecord& closure = map.closures()[id];
    if (!closure.is_verified) continue;
    LoopConstraint loop;
    loop.from = static_cast<int>(closure.match_keyframe.index());
    loop.to = static_cast<int>(closure.query_keyframe.index());
    loop.T_from_to = closure.T_match_query;
    loop.cov = config_.loop_cov_scale * closure.cov;
    loop.cov.diagonal().head<3>().array() += config_.loop_floor_m * config_.loop_floor_m;
    loop.cov.diagonal().tail<3>().array() += config_.loop_floor_rad * config_.loop_floor_rad;
    loop.is_certain = closure.source == ClosureSource::kRequest;
    graph_.addLoopClosure(loop);
    closure_of_factor_.push_back(id);
  }
  next_closure_ = map.closures().nextId();
  GraphUpdate update;
  update.decisions = decisionsOf(graph_.decide());
  return update;
}

GraphUpdate MapGraph::optimize(const std::vector<std::vector<LandmarkId>>& changed) {
  regroup(changed);
  return updateOf(graph_.optimize());
}

GraphUpdate MapGraph::optimizeFully(const std::vector<std::vector<LandmarkId>>& changed) {
  regroup(changed);
  return updateOf(graph_.optimizeFully());
}

void MapGraph::settle(Map& map, bool is_whole) {
  map.apply(review(map));
  for (int solution = 0; solution <= kMoreSolutions; ++solution) {
    const auto changed = map.takeChanges();
    map.apply(is_whole ? optimizeFully(changed) : optimize(changed));
    if (map.identity().changedNames().empty()) return;
  }
}

void MapGraph::regroup(const std::vector<std::vector<LandmarkId>>& changed) {
  std::vector<std::vector<std::int64_t>> groups;
  for (const std::vector<LandmarkId>& names : changed) groups.emplace_back(names.begin(), names.end());
  graph_.regroup(groups);
}

std::vector<ClosureDecision> MapGraph::decisionsOf(const std::vector<LoopDecision>& decisions) const {
  std::vector<ClosureDecision> result;
  for (const LoopDecision& decision : decisions) {
    result.push_back({closure_of_factor_[decision.loop], decision.state == LoopState::kAccepted});
    if (decision.state == LoopState::kRemoved) result.back().reason = "removed by request";
  }
  return result;
}

GraphUpdate MapGraph::updateOf(const PoseGraphUpdate& update) {
  if (!update.failure.empty()) {
    ++status_.failures;
    status_.newest_failure = update.failure;
  }
  return {graph_.poses(), decisionsOf(update.loop_changes), update.failure};
}

Pose MapGraph::T_map_odom(const Map& map) const {
  if (T_map_odom_start_) return *T_map_odom_start_;
  if (map.T_map_keyframes().empty()) return Pose::identity();
  return map.T_map_keyframes().back() * map.keyframes().back().T_odom_base.inverse();
}

std::optional<Eigen::Vector3d> MapGraph::landmark(LandmarkId id) const {
  return graph_.landmark(id);
}

LandmarkId MapGraph::keptName(LandmarkId id) const {
  return static_cast<LandmarkId>(graph_.keptNumber(static_cast<std::int64_t>(id)));
}

/// Of nodes that came by odometry.
std::vector<PoseNode> MapGraph::expectedOdometry(const Map& map) const {
  std::vector<PoseNode> nodes;
  for (const KeyframeId id : map.keyframes().ids()) {
    const auto known = odometry_.find(map.keyframes()[id].submap);
    nodes.push_back(known == odometry_.end() ? PoseNode{} : odometryNode(map, id, known->second));
  }
  return nodes;
}

void MapGraph::transfer(StateArchive& archive, const Map& map) {
  archive(odometry_);
  if (!odometry_.empty() && !map.submaps().has(odometry_.rbegin()->first)) {
    StateArchive::fail("odometry of a submap that there is not");
  }
  graph_.transfer(archive, expectedOdometry(map));
  archive(T_map_odom_start_);
  if (graph_.poses().size() != map.keyframes().size()) StateArchive::fail("a graph of other keyframes");
  if (!archive.isReading()) return;
  next_closure_ = map.closures().nextId();
  for (const ClosureId id : map.closures().ids()) {
    if (map.closures()[id].is_verified) closure_of_factor_.push_back(id);
  }
  if (closure_of_factor_.size() != graph_.loopDecisions().size()) StateArchive::fail("a graph of other closures");
}

}  // namespace semantic_mht_slam
