#include "subgraph.h"

#include <algorithm>
#include <cmath>

#include <Eigen/SparseCholesky>
#include <ceres/crs_matrix.h>
#include <ceres/solver.h>

#include "semantic_mht_slam/common/dense_solvers.h"

#include "lent_problem.h"
#include "marginals.h"
#include "solver_steps.h"

namespace semantic_mht_slam {
namespace {

constexpr double kContested = 9.0;  // squared distance in units of the squared scale of the robust loss

/// What sightings from nodes that stay where they are say about a landmark: in its position they are linear, so that
/// any number of them is one Gaussian.
class SightingsTogether {
 public:
  /// Squared whitened distance of a sighting from a position.
  static double distanceSq(const Pose& T_world_node, const PointCost<3>& sighting, const Eigen::Vector3d& landmark_m) {
    const Eigen::Vector3d error = T_world_node.inverse() * landmark_m - sighting.measured();
    return (sighting.squareRoot() * error).squaredNorm();
  }

  void add(const Pose& T_world_node, const PointCost<3>& sighting, double weight) {
    const Eigen::Matrix3d by_point = sighting.squareRoot() * T_world_node.rotation.conjugate().toRotationMatrix();
    const Eigen::Matrix3d information = weight * by_point.transpose() * by_point;
    information_ += information;
    weighted_ += information * (T_world_node * sighting.measured());
  }

  bool isEmpty() const { return information_.isZero(0.0); }
  Eigen::Vector3d mean_m() const { return solved(information_, weighted_); }
  const Eigen::Matrix3d& information() const { return information_; }

 private:
  Eigen::Matrix3d information_ = Eigen::Matrix3d::Zero();
  Eigen::Vector3d weighted_ = Eigen::Vector3d::Zero();
};

/// J^T J of a Jacobian in Ceres's row storage.
Eigen::SparseMatrix<double> normalMatrix(const ceres::CRSMatrix& jacobian) {
  const Eigen::Map<const Eigen::SparseMatrix<double, Eigen::RowMajor>> rows(
      jacobian.num_rows, jacobian.num_cols, static_cast<int>(jacobian.values.size()), jacobian.rows.data(),
      jacobian.cols.data(), jacobian.values.data());
  const Eigen::SparseMatrix<double> columns = rows;
  return columns.transpose() * columns;
}

}  // namespace

Subgraph::Subgraph(GraphState& graph, std::vector<int> nodes, Surroundings surroundings, const PoseGraphConfig& config)
    : graph_(graph),
      nodes_(std::move(nodes)),
      surroundings_(surroundings),
      fixed_(surroundings == Surroundings::kIgnored ? nodes_.front() : 0),
      landmark_scale_(config.landmark_cauchy_scale),
      loop_loss_(config.loop_cauchy_scale),
      landmark_loss_(config.landmark_cauchy_scale),
      problem_(lentProblemOptions()) {
  for (const int node : nodes_) addPose(node);
  for (const int node : nodes_) addNodeFactors(node);
  for (const int node : nodes_) {
    for (const std::int64_t id : graph_.nodes[node].landmarks) {
      if (landmarks_.count(id) == 0) addLandmark(id);
    }
  }
  addPositions();
}

/// Only where everything can move: positions that the others contradict would but bend a few nodes.
void Subgraph::addPositions() {
  const bool is_whole = surroundings_ == Surroundings::kHeld && nodes_.size() == graph_.nodes.size();
  has_positions_ = is_whole && graph_.outer.is_aligned;
  if (has_positions_) graph_.outer.addTo(problem_, [this](int node) { return graph_.nodes[node].block.data(); });
}

bool Subgraph::isInside(int node) const {
  return std::binary_search(nodes_.begin(), nodes_.end(), node);
}

bool Subgraph::isVariable(int node) const {
  return node != fixed_ && isInside(node);
}

/// Adds the block of a node once; nodes from outside are held.
void Subgraph::addPose(int node) {
  double* block = graph_.nodes[node].block.data();
  if (problem_.HasParameterBlock(block)) return;
  problem_.AddParameterBlock(block, kPoseBlock);
  setManifold(problem_, block, &manifold_);
  if (!isVariable(node)) problem_.SetParameterBlockConstant(block);
}

void Subgraph::add(ceres::CostFunction* cost, ceres::LossFunction* loss, double* from, double* to) {
  if (problem_.IsParameterBlockConstant(from) && problem_.IsParameterBlockConstant(to)) return;
  problem_.AddResidualBlock(cost, loss, from, to);
}

/// Odometry from the node before, odometry to one behind that is outside, loop closures, priors.
void Subgraph::addNodeFactors(int node) {
  NodeState& state = graph_.nodes[node];
  const bool take_outside = surroundings_ == Surroundings::kHeld;
  const auto join = [&](ceres::CostFunction* cost, ceres::LossFunction* loss, int from, int to) {
    addPose(from);
    addPose(to);
    add(cost, loss, graph_.nodes[from].block.data(), graph_.nodes[to].block.data());
  };
  if (node > 0 && (isInside(node - 1) || take_outside)) {
    join(state.odometry_cost.get(), nullptr, node - 1, node);
  }
  const int next = node + 1;
  if (take_outside && next < graph_.nodeCount() && !isInside(next)) {
    join(graph_.nodes[next].odometry_cost.get(), nullptr, node, next);
  }
  if (!take_outside) return;
  for (const int index : state.loops) {
    const LoopState3& loop = graph_.loops[index];
    if (loop.state != LoopState::kAccepted || !loop.is_reviewed) continue;
    const int other = loop.constraint.from == node ? loop.constraint.to : loop.constraint.from;
    if (isInside(other) && other < node) continue;  // was added there
    ceres::LossFunction* loss = loop.constraint.is_certain ? nullptr : &loop_loss_;
    join(loop.cost.get(), loss, loop.constraint.from, loop.constraint.to);
  }
  for (const PriorFactor& prior : state.priors) {
    if (!problem_.HasParameterBlock(world_.data())) {
      problem_.AddParameterBlock(world_.data(), kPoseBlock);
      problem_.SetParameterBlockConstant(world_.data());
    }
    add(prior.cost.get(), nullptr, world_.data(), state.block.data());
  }
}

void Subgraph::addLandmark(std::int64_t id) {
  LandmarkState& landmark = graph_.landmarks.at(id);
  double* block = landmarks_.emplace(id, graph_.landmarkInWorld(landmark)).first->second.data();
  problem_.AddParameterBlock(block, 3);
  const auto addSighting = [&](const SightingFactor& sighting) {
    problem_.AddResidualBlock(sighting.cost.get(), &landmark_loss_, graph_.nodes[sighting.node].block.data(), block);
  };
  SightingsTogether inside;
  for (const SightingFactor& sighting : landmark.sightings) {
    if (!isInside(sighting.node)) continue;
    addSighting(sighting);
    inside.add(graph_.nodes[sighting.node].pose(), *sighting.cost, 1.0);
  }
  const bool is_seen_outside = !isInside(landmark.sightings.front().node) || !isInside(landmark.sightings.back().node);
  if (surroundings_ == Surroundings::kHeld && is_seen_outside) addHeldSightings(landmark, inside.mean_m(), block);
}

/// The weight of each is that of the robust loss where the nodes inside see the landmark. Sightings far from there
/// mean a loop that is still open: closing it is not for a few nodes, which it would only bend.
void Subgraph::addHeldSightings(const LandmarkState& landmark, const Eigen::Vector3d& seen_inside_m, double* block) {
  const double scale_sq = landmark_scale_ * landmark_scale_;
  SightingsTogether held;
  for (const SightingFactor& sighting : landmark.sightings) {
    if (isInside(sighting.node)) continue;
    const Pose T_world_node = graph_.nodes[sighting.node].pose();
    const double ratio = SightingsTogether::distanceSq(T_world_node, *sighting.cost, seen_inside_m) / scale_sq;
    if (ratio < kContested) held.add(T_world_node, *sighting.cost, 1.0 / (1.0 + ratio));
  }
  if (held.isEmpty()) return;
  problem_.AddResidualBlock(&held_.emplace_back(held.mean_m(), held.information()), nullptr, block);
}

std::vector<double> Subgraph::snapshot() const {
  std::vector<double> values;
  for (const int node : nodes_) {
    const auto& block = graph_.nodes[node].block;
    values.insert(values.end(), block.begin(), block.end());
  }
  if (has_positions_) values.insert(values.end(), graph_.outer.block.begin(), graph_.outer.block.end());
  return values;
}

void Subgraph::restore(const std::vector<double>& backup) {
  auto value = backup.begin();
  for (const int node : nodes_) {
    std::copy_n(value, kPoseBlock, graph_.nodes[node].block.begin());
    value += kPoseBlock;
  }
  if (has_positions_) std::copy_n(value, kPoseBlock, graph_.outer.block.begin());
}

/// Landmarks are kept in the frame of the node that saw them first.
void Subgraph::storeLandmarks() {
  for (const auto& [id, position_m] : landmarks_) {
    LandmarkState& landmark = graph_.landmarks.at(id);
    landmark.position_m = graph_.nodes[landmark.anchor].pose().inverse() * position_m;
  }
}

Subgraph::Outcome Subgraph::optimize(int max_iterations, double max_seconds, double tolerance) {
  const std::vector<double> backup = snapshot();
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.initial_trust_region_radius = 1e16;
  options.jacobi_scaling = false;
  options.max_num_iterations = max_iterations;
  options.function_tolerance = tolerance;
  options.logging_type = ceres::SILENT;
  if (max_seconds > 0.0) options.max_solver_time_in_seconds = max_seconds;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem_, &summary);
  Outcome outcome;
  outcome.iterations = iterationsOf(summary);
  outcome.out_of_time = summary.termination_type == ceres::NO_CONVERGENCE && outcome.iterations < max_iterations;
  const std::vector<double> result = snapshot();
  const bool is_finite = std::all_of(result.begin(), result.end(), [](double value) { return std::isfinite(value); });
  if (!summary.IsSolutionUsable()) outcome.failure = "the solver failed: " + summary.message;
  if (!is_finite || !std::isfinite(summary.final_cost)) outcome.failure = "the solution is not finite";
  if (outcome.failure.empty()) {
    storeLandmarks();
  } else {
    restore(backup);
  }
  return outcome;
}

double Subgraph::cost() {
  ceres::Problem::EvaluateOptions options;
  options.apply_loss_function = false;
  double cost = 0.0;
  problem_.Evaluate(options, &cost, nullptr, nullptr, nullptr);
  return cost;
}

/// What the shared errors of the odometry between the nodes weigh on the steps of the variable ones.
Eigen::MatrixXd Subgraph::sharedGradient(int columns) const {
  Eigen::MatrixXd gradient = Eigen::MatrixXd::Zero(columns, kSharedErrors);
  int first = 0;  // column of the node
  for (const int node : nodes_) {
    const int before = first - (isVariable(node - 1) ? 6 : 0);
    const NodeState& state = graph_.nodes[node];
    if (isInside(node - 1) && !state.shared_errors.isZero(0.0)) {
      const WhitenedRelation relation =
          whiten(*state.odometry_cost, nullptr, graph_.nodes[node - 1].block.data(), state.block.data());
      const SharedErrors whitened = state.odometry_cost->squareRoot() * state.shared_errors;
      if (isVariable(node - 1)) gradient.middleRows<6>(before) += relation.by_from.transpose() * whitened;
      if (isVariable(node)) gradient.middleRows<6>(first) += relation.by_to.transpose() * whitened;
    }
    if (isVariable(node)) first += 6;
  }
  return gradient;
}

std::optional<NodeMarginal> Subgraph::marginal(int node) {
  ceres::Problem::EvaluateOptions options;
  int first = 0;
  int columns = 0;
  if (!isVariable(node)) return std::nullopt;
  for (const int other : nodes_) {
    if (!isVariable(other)) continue;
    if (other == node) first = columns;
    options.parameter_blocks.push_back(graph_.nodes[other].block.data());
    columns += 6;
  }
  for (auto& [id, position_m] : landmarks_) {
    options.parameter_blocks.push_back(position_m.data());
    columns += 3;
  }
  ceres::CRSMatrix jacobian;
  if (!problem_.Evaluate(options, nullptr, nullptr, nullptr, &jacobian)) return std::nullopt;
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(normalMatrix(jacobian));
  if (factor.info() != Eigen::Success || !(factor.vectorD().minCoeff() > 0.0)) return std::nullopt;
  Eigen::MatrixXd unit = Eigen::MatrixXd::Zero(columns, 6);
  unit.middleRows<6>(first).setIdentity();
  const Eigen::MatrixXd effect = factor.solve(unit);
  Eigen::MatrixXd covariance = effect.middleRows<6>(first);
  covariance = 0.5 * (covariance + covariance.transpose()).eval();
  if (!covariance.allFinite()) return std::nullopt;
  const Pose T_world_node = graph_.nodes[node].pose();
  const Eigen::MatrixXd shared = effect.transpose() * sharedGradient(columns);
  return NodeMarginal{node, errorCov(T_world_node, covariance), sharedErrors(T_world_node, shared)};
}

}  // namespace semantic_mht_slam
