#include "semantic_mht_slam/graph/batch_solver.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "semantic_mht_slam/graph/initial_guess.h"
#include "semantic_mht_slam/graph/loop_consistency.h"

#include "batch_problem.h"
#include "solver_steps.h"

namespace semantic_mht_slam {
namespace {

/// A guess whose F is below this share of its expectation (half the number of equations) fits so well already that a
/// better one would save no iteration. Affects the time only.
constexpr double kGoodGuess = 0.1;

/// 99 % quantile of chi-square with 3 or 6 degrees of freedom.
template <int kDim>
constexpr double kGate = kDim == 2 ? 11.345 : 16.812;

/// 1 - 1e-6 quantile: so few right loop closures exceed it that a graph without such an outlier is taken as sound.
template <int kDim>
constexpr double kSoundGate = kDim == 2 ? 30.665 : 38.258;

constexpr int kReadmissionRounds = 3;
constexpr int kPlainIterations = 10;

/// Levenberg-Marquardt that starts as Gauss-Newton: from a good guess the first full step is right, and a step that is
/// not is damped as usual. Every figure behind these choices is in docs/decisions.md.
ceres::Solver::Options solverOptions(const BatchOptions& options) {
  ceres::Solver::Options result;
  result.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  result.initial_trust_region_radius = 1e16;
  result.max_num_iterations = options.max_iterations;
  result.jacobi_scaling = false;
  result.num_threads = 1;
  result.logging_type = ceres::SILENT;
  return result;
}

template <int kDim>
double mahalanobisSq(const BatchGraph<kDim>& graph, const typename BatchGraph<kDim>::PoseEdge& edge) {
  const auto error =
      edgeError(graph.poses[edge.from].T_world_vertex, graph.poses[edge.to].T_world_vertex, edge.T_from_to);
  return error.dot(edge.information * error);
}

template <int kDim>
double halfEquations(const BatchGraph<kDim>& graph) {
  return 0.5 * (BatchGraph<kDim>::kDof * static_cast<double>(graph.pose_edges.size()) +
                kDim * static_cast<double>(graph.point_edges.size()));
}

/// Moves the graph to the chordal guess if that costs less. Points follow the pose that sees them first.
template <int kDim>
bool moveToChordalGuess(BatchGraph<kDim>& graph, const std::vector<bool>& use_edge, double present_cost) {
  BatchGraph<kDim> guess = graph;
  guess.pose_edges.clear();
  for (std::size_t i = 0; i < use_edge.size(); ++i) {
    if (use_edge[i]) guess.pose_edges.push_back(graph.pose_edges[i]);
  }
  const auto poses = chordalGuess(guess);
  if (!poses) return false;
  for (std::size_t i = 0; i < poses->size(); ++i) guess.poses[i].T_world_vertex = (*poses)[i];
  for (auto& point : guess.points) point.has_estimate = false;
  fillMissingEstimates(guess);
  if (!(cost(guess) < present_cost)) return false;
  graph.poses = guess.poses;
  graph.points = guess.points;
  return true;
}

template <int kDim>
double costOf(const BatchGraph<kDim>& graph, const std::vector<bool>& use_edge) {
  double sum = cost(graph);
  for (std::size_t i = 0; i < use_edge.size(); ++i) {
    if (!use_edge[i]) sum -= 0.5 * mahalanobisSq(graph, graph.pose_edges[i]);
  }
  return sum;
}

/// One optimisation with a given choice of edges; an empty string or the reason why there is no result.
template <int kDim>
std::string solveOnce(BatchGraph<kDim>& graph, const std::vector<bool>& use_edge, const BatchOptions& options,
                      BatchReport& report) {
  const std::unique_ptr<ceres::LossFunction> loss(options.cauchy ? new ceres::CauchyLoss(options.cauchy_scale)
                                                                 : nullptr);
  BatchProblem<kDim> problem(graph, use_edge, loss.get());
  ceres::Solver::Summary summary;
  problem.solve(solverOptions(options), summary);
  report.iterations += iterationsOf(summary);
  report.converged = summary.termination_type == ceres::CONVERGENCE;
  if (!summary.IsSolutionUsable()) return "the solver failed: " + summary.message;
  if (!std::isfinite(summary.final_cost) || !problem.store(graph)) return "the solution is not finite";
  return {};
}

/// Loop closures that agree with the result although the consistency test left them out come back; true if any did.
template <int kDim>
bool readmitLoops(const BatchGraph<kDim>& graph, std::vector<bool>& use_edge) {
  bool changed = false;
  for (std::size_t i = 0; i < use_edge.size(); ++i) {
    if (use_edge[i] || mahalanobisSq(graph, graph.pose_edges[i]) > kGate<kDim>) continue;
    use_edge[i] = true;
    changed = true;
  }
  return changed;
}

/// True if plain least squares over every edge explains all loop closures: then none of them is wrong, and the
/// consistency test, whose cost grows with the square of their number, has nothing to find. The graph is moved to that
/// solution.
template <int kDim>
bool fitsAsAWhole(BatchGraph<kDim>& graph, const BatchOptions& options, BatchReport& report) {
  BatchOptions plain = options;
  plain.cauchy = false;
  plain.max_iterations = std::min(options.max_iterations, kPlainIterations);
  BatchGraph<kDim> trial = graph;
  if (!solveOnce(trial, std::vector<bool>(graph.pose_edges.size(), true), plain, report).empty()) return false;
  for (const auto& edge : trial.pose_edges) {
    if (!isOdometry(edge) && mahalanobisSq(trial, edge) > kSoundGate<kDim>) return false;
  }
  graph.poses = trial.poses;
  graph.points = trial.points;
  return true;
}

/// Moves the graph to a better start where there is one.
template <int kDim>
void improveStart(BatchGraph<kDim>& graph, const std::vector<bool>& use_edge, const BatchOptions& options,
                  BatchReport& report) {
  const double given = costOf(graph, use_edge);
  // With several held poses the relaxation, which holds one, could only be worse.
  const bool may_try = options.try_chordal_guess && graph.fixed_poses.size() < 2;
  const bool is_good = given < kGoodGuess * halfEquations(graph);
  report.started_from_chordal_guess = may_try && !is_good && moveToChordalGuess(graph, use_edge, given);
  report.start_cost = report.started_from_chordal_guess ? costOf(graph, use_edge) : given;
}

/// Leaves out loop closures until the rest is consistent.
template <int kDim>
std::string solveWithConsistentLoops(BatchGraph<kDim>& graph, const BatchOptions& options, BatchReport& report,
                                     std::vector<bool>& use_edge) {
  BatchGraph<kDim> whole = graph;
  improveStart(whole, use_edge, options, report);
  if (fitsAsAWhole(whole, options, report)) {
    graph = whole;
    return solveOnce(graph, use_edge, options, report);
  }
  for (const int edge : findConsistentLoops(graph, kGate<kDim>, options.odometry_cov_scale).inconsistent) {
    use_edge[edge] = false;
  }
  improveStart(graph, use_edge, options, report);
  for (int round = 0; round < kReadmissionRounds; ++round) {
    std::string failure = solveOnce(graph, use_edge, options, report);
    if (!failure.empty() || !readmitLoops(graph, use_edge)) return failure;
  }
  return solveOnce(graph, use_edge, options, report);
}

template <int kDim>
std::string solveAll(BatchGraph<kDim>& graph, const BatchOptions& options, BatchReport& report) {
  std::vector<bool> use_edge(graph.pose_edges.size(), true);
  std::string failure;
  if (options.reject_inconsistent_loops) {
    failure = solveWithConsistentLoops(graph, options, report, use_edge);
  } else {
    improveStart(graph, use_edge, options, report);
    failure = solveOnce(graph, use_edge, options, report);
  }
  if (!failure.empty()) return failure;
  report.final_cost = cost(graph);
  report.accepted_cost = costOf(graph, use_edge);
  for (int i = 0; i < graph.edgeCount(); ++i) {
    if (use_edge[i]) continue;
    report.rejected_loops.push_back({i, mahalanobisSq(graph, graph.pose_edges[i])});
  }
  return {};
}

}  // namespace

template <int kDim>
BatchReport optimizeBatch(BatchGraph<kDim>& graph, const BatchOptions& options) {
  if (!(options.cauchy_scale > 0.0) || !(options.odometry_cov_scale >= 1.0) || options.max_iterations < 0) {
    throw std::invalid_argument("optimizeBatch: option out of range");
  }
  BatchReport report;
  if (auto defect = findDefect(graph)) {
    report.failure = *defect;
    return report;
  }
  BatchGraph<kDim> trial = graph;
  fillMissingEstimates(trial);
  report.initial_cost = cost(trial);
  report.failure = solveAll(trial, options, report);
  if (report.failure.empty()) {
    graph.poses = trial.poses;
    graph.points = trial.points;
  }
  return report;
}

template BatchReport optimizeBatch<2>(BatchGraph<2>&, const BatchOptions&);
template BatchReport optimizeBatch<3>(BatchGraph<3>&, const BatchOptions&);

}  // namespace semantic_mht_slam
