#include "semantic_mht_slam/graph/pose_graph.h"

#include <algorithm>
#include <numeric>

#include <Eigen/LU>

#include "semantic_mht_slam/common/state_archive.h"

#include "deadline.h"
#include "graph_archive.h"
#include "hierarchy.h"
#include "loop_review.h"
#include "pose_graph_checks.h"
#include "subgraph.h"

namespace semantic_mht_slam {
namespace {

constexpr int kFullIterations = 50;
constexpr double kFullTolerance = 1e-6;  // of the cost; what is left of the poses is a few centimetres
constexpr int kRepairIterations = 1;     // an interpolated piece is so near its optimum that one step reaches it
constexpr double kWindowShare = 0.5;     // of a time budget, so that loop closures get the rest

std::vector<int> range(int first, int end) {
  std::vector<int> numbers(end - first);
  std::iota(numbers.begin(), numbers.end(), first);
  return numbers;
}

}  // namespace

class PoseGraph::Impl {
 public:
  explicit Impl(const PoseGraphConfig& config) : config_(config), review_(config_), hierarchy_(config_) {}

  int addSubmap(const SubmapNode& node);
  int addLoopClosure(const LoopConstraint& loop);
  void addPrior(int submap, const Pose& T_world_submap, const PoseCov& cov);
  void mergeLandmarks(std::int64_t merged, std::int64_t survivor);
  PoseGraphUpdate optimize();
  PoseGraphUpdate optimizeFully();
  Subgraph whole(GraphState& graph) const;
  std::vector<LoopDecision> decisions() const;
  void transfer(StateArchive& archive);

  mutable GraphState graph_;  // lent to Ceres, whose interface takes mutable addresses also for evaluation

 private:
  bool solveGlobally(const Deadline& deadline, PoseGraphUpdate& update);
  void closeLoops(const Deadline& deadline, PoseGraphUpdate& update);
  bool solveWindow(const std::vector<int>& submaps, int iterations, double max_seconds, PoseGraphUpdate& update);
  void reportChanges(PoseGraphUpdate& update);

  PoseGraphConfig config_;
  LoopReview review_;
  Hierarchy hierarchy_;
  int in_hierarchy_ = 0;
  std::vector<LoopState> reported_;
  std::vector<OdometryStep> odometry_;
};

int PoseGraph::Impl::addSubmap(const SubmapNode& node) {
  const int index = static_cast<int>(graph_.submaps.size());
  check(node, index == 0);
  SubmapState& submap = graph_.submaps.emplace_back();
  const Pose before = index == 0 ? Pose::identity() : graph_.submaps[index - 1].pose();
  writeBlock(before * node.T_previous_submap, submap.block.data());
  if (index > 0) {
    submap.odometry_cost = std::make_unique<RelativePose3Cost>(node.T_previous_submap, node.odometry_cov.inverse());
  }
  for (const LandmarkSighting& sighting : node.sightings) graph_.addSighting(sighting);
  odometry_.push_back({node.T_previous_submap, node.odometry_cov});
  review_.extendOdometry(node.T_previous_submap, node.odometry_cov, index == 0);
  return index;
}

int PoseGraph::Impl::addLoopClosure(const LoopConstraint& loop) {
  const int count = static_cast<int>(graph_.submaps.size());
  require(loop.from >= 0 && loop.from < count && loop.to >= 0 && loop.to < count && loop.from != loop.to,
          "a loop closure joins two different submaps that exist");
  require(loop.T_from_to.isValid(), "a loop closure is not a finite pose");
  require(isCovariance6(loop.cov), "a loop closure's covariance is not positive definite");
  const int index = static_cast<int>(graph_.loops.size());
  LoopState3& state = graph_.loops.emplace_back();
  state.constraint = loop;
  state.cost = std::make_unique<RelativePose3Cost>(loop.T_from_to, loop.cov.inverse());
  graph_.submaps[loop.from].loops.push_back(index);
  graph_.submaps[loop.to].loops.push_back(index);
  review_.add(graph_, loop);
  return index;
}

void PoseGraph::Impl::addPrior(int submap, const Pose& T_world_submap, const PoseCov& cov) {
  require(submap >= 0 && submap < static_cast<int>(graph_.submaps.size()), "a prior is for a submap that exists");
  require(T_world_submap.isValid() && isCovariance6(cov), "a prior is not finite or not positive definite");
  graph_.submaps[submap].priors.push_back(
      {T_world_submap, cov, std::make_unique<RelativePose3Cost>(T_world_submap, cov.inverse())});
  ++graph_.priors;
}

void PoseGraph::Impl::mergeLandmarks(std::int64_t merged, std::int64_t survivor) {
  require(merged != survivor, "a landmark is not merged with itself");
  const std::int64_t from = graph_.keptNumber(merged);
  const std::int64_t to = graph_.keptNumber(survivor);
  require(graph_.landmarks.count(from) > 0 && graph_.landmarks.count(to) > 0, "only landmarks that exist are merged");
  if (from != to) hierarchy_.touch(graph_.mergeLandmarks(from, to));
}

void PoseGraph::Impl::transfer(StateArchive& archive) {
  transferGraph(archive, config_, odometry_, graph_, review_);
  archive(hierarchy_, in_hierarchy_, reported_);
}

/// True if the solution was not cut short.
bool PoseGraph::Impl::solveWindow(const std::vector<int>& submaps, int iterations, double max_seconds,
                                  PoseGraphUpdate& update) {
  Subgraph window(graph_, submaps, Surroundings::kHeld, config_);
  const Subgraph::Outcome outcome = window.optimize(iterations, max_seconds);
  update.iterations += outcome.iterations;
  update.out_of_time = update.out_of_time || outcome.out_of_time;
  if (!outcome.failure.empty()) update.failure = outcome.failure;
  return outcome.failure.empty() && !outcome.out_of_time;
}

/// True if the skeleton was solved. What there is no time for stays pending for the next call.
bool PoseGraph::Impl::solveGlobally(const Deadline& deadline, PoseGraphUpdate& update) {
  if (!hierarchy_.update(graph_, review_)) return false;
  if (deadline.hasPassed()) {
    update.out_of_time = true;
    return false;
  }
  const Skeleton::Outcome outcome = hierarchy_.solve(graph_, review_, deadline.left_s());
  update.iterations += outcome.iterations;
  update.moved_everything = true;
  update.out_of_time = update.out_of_time || outcome.out_of_time;
  if (!outcome.failure.empty()) {
    update.failure = outcome.failure;
    return false;
  }
  if (!outcome.out_of_time) hierarchy_.settle();
  return true;
}

PoseGraphUpdate PoseGraph::Impl::optimize() {
  const Deadline deadline(config_.time_budget_s);
  PoseGraphUpdate update;
  const int count = static_cast<int>(graph_.submaps.size());
  if (count == 0) return update;
  solveWindow(range(std::max(0, count - config_.window_submaps), count), config_.window_iterations,
              deadline.left_s(kWindowShare), update);
  hierarchy_.synchronize(graph_);
  const bool has_time = in_hierarchy_ == count;  // no new submap
  for (; in_hierarchy_ < count; ++in_hierarchy_) hierarchy_.extend(graph_, review_, in_hierarchy_);
  hierarchy_.linkTouched(graph_, review_);
  review_.decide(graph_);
  closeLoops(deadline, update);
  if (!deadline.hasPassed()) {
    const std::vector<int> touched = hierarchy_.takeTouched(graph_);
    if (!touched.empty()) solveWindow(touched, config_.window_iterations, deadline.left_s(), update);
  }
  const int interval = config_.repair_interval;
  if (interval > 0 && (has_time || count % interval == 0) && !deadline.hasPassed()) {
    const std::vector<int> bent = hierarchy_.takeBentPiece(graph_);
    if (!bent.empty()) solveWindow(bent, kRepairIterations, deadline.left_s(), update);
  }
  update.out_of_time = update.out_of_time || deadline.hasPassed();
  reportChanges(update);
  return update;
}

/// Lets new loop closures act on the whole drive.
void PoseGraph::Impl::closeLoops(const Deadline& deadline, PoseGraphUpdate& update) {
  const bool is_solved = solveGlobally(deadline, update);
  const int count = static_cast<int>(graph_.submaps.size());
  const bool is_small = count <= config_.whole_submaps && !deadline.hasPassed();
  if (update.failure.empty() && (is_solved || hierarchy_.hasNews()) && is_small) {
    if (solveWindow(range(0, count), config_.window_iterations, deadline.left_s(), update))
      hierarchy_.finishWhole(graph_);
    hierarchy_.synchronize(graph_);
    update.moved_everything = true;
  }
  if (!is_solved || hierarchy_.isPending()) return;
  review_.compareWithEstimate(graph_, [this](int loop) { return hierarchy_.gap(graph_, loop); });
  solveGlobally(deadline, update);  // if that switched any loop closure
}

Subgraph PoseGraph::Impl::whole(GraphState& graph) const {
  return Subgraph(graph, range(0, static_cast<int>(graph.submaps.size())), Surroundings::kHeld, config_);
}

PoseGraphUpdate PoseGraph::Impl::optimizeFully() {
  PoseGraphUpdate update = optimize();
  if (graph_.submaps.empty()) return update;
  const Subgraph::Outcome outcome = whole(graph_).optimize(kFullIterations, 0.0, kFullTolerance);
  update.iterations += outcome.iterations;
  update.moved_everything = true;
  if (!outcome.failure.empty()) update.failure = outcome.failure;
  if (outcome.failure.empty()) hierarchy_.finishWhole(graph_);
  reportChanges(update);
  return update;
}

void PoseGraph::Impl::reportChanges(PoseGraphUpdate& update) {
  const int known = static_cast<int>(reported_.size());
  for (int i = std::min(known, review_.firstOpen(graph_)); i < static_cast<int>(graph_.loops.size()); ++i) {
    const LoopState3& loop = graph_.loops[i];
    const bool is_new = i >= known;
    if (is_new) reported_.push_back(loop.state);
    if (!is_new && reported_[i] == loop.state) continue;
    reported_[i] = loop.state;
    update.loop_changes.push_back({i, loop.state, mahalanobisSq(graph_, loop.constraint)});
  }
}

std::vector<LoopDecision> PoseGraph::Impl::decisions() const {
  std::vector<LoopDecision> result;
  for (int i = 0; i < static_cast<int>(graph_.loops.size()); ++i) {
    result.push_back({i, graph_.loops[i].state, mahalanobisSq(graph_, graph_.loops[i].constraint)});
  }
  return result;
}

PoseGraph::PoseGraph(const PoseGraphConfig& config) {
  check(config);
  impl_ = std::make_unique<Impl>(config);
}
PoseGraph::~PoseGraph() = default;
PoseGraph::PoseGraph(PoseGraph&&) noexcept = default;
PoseGraph& PoseGraph::operator=(PoseGraph&&) noexcept = default;

int PoseGraph::addSubmap(const SubmapNode& submap) {
  return impl_->addSubmap(submap);
}
int PoseGraph::addLoopClosure(const LoopConstraint& loop) {
  return impl_->addLoopClosure(loop);
}
void PoseGraph::addPrior(int submap, const Pose& T_world_submap, const PoseCov& cov) {
  impl_->addPrior(submap, T_world_submap, cov);
}
void PoseGraph::mergeLandmarks(std::int64_t merged, std::int64_t survivor) {
  impl_->mergeLandmarks(merged, survivor);
}
PoseGraphUpdate PoseGraph::optimize() {
  return impl_->optimize();
}
PoseGraphUpdate PoseGraph::optimizeFully() {
  return impl_->optimizeFully();
}
void PoseGraph::transfer(StateArchive& archive) {
  if (archive.isReading() && submaps() > 0) throw std::logic_error("PoseGraph: a state is read into an empty graph");
  impl_->transfer(archive);
}
int PoseGraph::submaps() const {
  return static_cast<int>(impl_->graph_.submaps.size());
}

std::vector<Pose> PoseGraph::poses() const {
  std::vector<Pose> result;
  for (const SubmapState& submap : impl_->graph_.submaps) result.push_back(submap.pose());
  return result;
}

Pose PoseGraph::pose(int submap) const {
  require(submap >= 0 && submap < submaps(), "there is no such submap");
  return impl_->graph_.submaps[submap].pose();
}

std::optional<Eigen::Vector3d> PoseGraph::landmark(std::int64_t id) const {
  const auto found = impl_->graph_.landmarks.find(impl_->graph_.keptNumber(id));
  if (found == impl_->graph_.landmarks.end()) return std::nullopt;
  return impl_->graph_.landmarkInWorld(found->second);
}

std::vector<LoopDecision> PoseGraph::loopDecisions() const {
  return impl_->decisions();
}

double PoseGraph::cost() const {
  return submaps() == 0 ? 0.0 : impl_->whole(impl_->graph_).cost();
}

std::optional<PoseCov> PoseGraph::poseCovariance(int submap) const {
  require(submap >= 0 && submap < submaps(), "there is no such submap");
  if (submap == 0) return PoseCov::Zero();
  const auto step_cov = impl_->whole(impl_->graph_).poseStepCovariance(submap);
  if (!step_cov) return std::nullopt;
  return errorCov(pose(submap), *step_cov);
}

std::optional<Eigen::Matrix3d> PoseGraph::landmarkCovariance(std::int64_t id) const {
  if (submaps() == 0) return std::nullopt;
  const auto cov = impl_->whole(impl_->graph_).landmarkCovariance(impl_->graph_.keptNumber(id));
  if (!cov) return std::nullopt;
  return Eigen::Matrix3d(*cov);
}

}  // namespace semantic_mht_slam
