#include "skeleton.h"

#include <algorithm>
#include <cmath>

#include <ceres/iteration_callback.h>
#include <ceres/solver.h>
#include <ceres/types.h>

#include "semantic_mht_slam/common/dense_solvers.h"

#include "lent_problem.h"
#include "marginals.h"
#include "solver_steps.h"

namespace semantic_mht_slam {
namespace {

constexpr double kTolerance = 1e-2;  // of the cost; what is left is done with the next loop closures

ceres::Problem::Options problemOptions() {
  ceres::Problem::Options options = lentProblemOptions();
  options.enable_fast_removal = true;
  return options;
}

/// Ends a solution after a step whose effect was foreseen: another one would gain no more than what was not. Ceres's
/// own test for that needs the next step, and throws it away.
class StopWhenForeseen final : public ceres::IterationCallback {
 public:
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& done) override {
    if (done.iteration == 0 || !done.step_is_successful || !(done.relative_decrease > 0.0)) {
      return ceres::SOLVER_CONTINUE;
    }
    const double missed = std::abs(done.cost_change - done.cost_change / done.relative_decrease);
    return missed <= kTolerance * done.cost ? ceres::SOLVER_TERMINATE_SUCCESSFULLY : ceres::SOLVER_CONTINUE;
  }
};

}  // namespace

Skeleton::Skeleton(double cauchy_scale) : loss_(cauchy_scale), problem_(problemOptions()) {
  problem_.AddParameterBlock(world_.data(), kPoseBlock);
  problem_.SetParameterBlockConstant(world_.data());
}

int Skeleton::addHub(const Pose& pose) {
  double* block = blocks_.emplace_back().data();
  writeBlock(pose, block);
  problem_.AddParameterBlock(block, kPoseBlock);
  setManifold(problem_, block, &manifold_);
  if (hubs() == 1) problem_.SetParameterBlockConstant(block);
  return hubs() - 1;
}

Pose Skeleton::pose(int hub) const {
  Pose pose;
  readBlock(blocks_[hub].data(), pose);
  return pose;
}

void Skeleton::setPose(int hub, const Pose& pose) {
  writeBlock(pose, blocks_[hub].data());
}

int Skeleton::addLink(int from, int to, const Pose& T_from_to, const PoseCov& cov, const SharedErrors& shared_errors) {
  Link& link = links_.emplace_back();
  link.cost = std::make_unique<RelativePose3Cost>(T_from_to, inverted(cov));
  link.shared_errors = shared_errors;
  link.from = from;
  link.to = to;
  return static_cast<int>(links_.size()) - 1;
}

double Skeleton::mahalanobisSq(int index) const {
  const Link& link = links_[index];
  const double* blocks[] = {block(link.from), block(link.to)};
  Vector6d whitened;
  link.cost->Evaluate(blocks, whitened.data(), nullptr);
  return whitened.squaredNorm();
}

void Skeleton::setActive(int index, bool is_active) {
  Link& link = links_[index];
  if (is_active == (link.id != nullptr)) return;
  if (is_active) {
    link.id =
        problem_.AddResidualBlock(link.cost.get(), link.is_robust ? &loss_ : nullptr, block(link.from), block(link.to));
  } else {
    problem_.RemoveResidualBlock(link.id);
    link.id = nullptr;
  }
}

void Skeleton::setRobust(int index, bool is_robust) {
  Link& link = links_[index];
  if (link.is_robust == is_robust) return;
  link.is_robust = is_robust;
  if (link.id == nullptr) return;
  setActive(index, false);
  setActive(index, true);
}

std::optional<std::vector<NodeMarginal>> Skeleton::marginals(const OuterFrame* outer) const {
  std::vector<std::vector<int>> cliques;
  for (const Link& link : links_) {
    if (link.id != nullptr) cliques.push_back({link.from, link.to});
  }
  const int frame = hubs();  // behind them, in the order of the poses
  if (outer != nullptr) {
    for (const OuterFrame::Factor& factor : outer->factors) cliques.push_back({factor.position.node, frame});
  }
  PoseInformation poses(outer != nullptr ? frame + 1 : frame, cliques);
  for (const Link& link : links_) {
    if (link.id == nullptr) continue;
    poses.add(*link.cost, link.is_robust ? &loss_ : nullptr, link.from, block(link.from), link.to, block(link.to),
              link.shared_errors);
  }
  if (outer != nullptr) outer->addTo(poses, frame, [this](int hub) { return block(hub); });
  if (!poses.solve()) return std::nullopt;
  std::vector<NodeMarginal> result;
  for (int hub = 0; hub < hubs(); ++hub) {
    result.push_back(
        {hub, errorCov(pose(hub), poses.ownStepCov(hub, hub)), sharedErrors(pose(hub), poses.sharedStep(hub))});
  }
  return result;
}

Skeleton::Outcome Skeleton::optimize(int max_iterations, double max_seconds, OuterFrame* outer) {
  const auto backup = blocks_;
  if (outer != nullptr) outer->addTo(problem_, [this](int hub) { return block(hub); });
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  // Half the time of CHOLMOD on a few hundred hubs (docs/decisions.md).
  if (ceres::IsSparseLinearAlgebraLibraryTypeAvailable(ceres::EIGEN_SPARSE)) {
    options.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
  }
  options.initial_trust_region_radius = 1e16;
  options.jacobi_scaling = false;
  options.max_num_iterations = max_iterations;
  options.function_tolerance = kTolerance;
  StopWhenForeseen stop;
  options.callbacks.push_back(&stop);
  options.logging_type = ceres::SILENT;
  if (max_seconds > 0.0) options.max_solver_time_in_seconds = max_seconds;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem_, &summary);
  if (outer != nullptr) problem_.RemoveParameterBlock(outer->block.data());  // with all that hangs on it
  Outcome outcome;
  outcome.iterations = iterationsOf(summary);
  outcome.converged = summary.termination_type == ceres::CONVERGENCE || summary.termination_type == ceres::USER_SUCCESS;
  outcome.out_of_time = summary.termination_type == ceres::NO_CONVERGENCE && outcome.iterations < max_iterations;
  bool is_finite = std::isfinite(summary.final_cost);
  if (outer != nullptr) {
    for (const double value : outer->block) is_finite = is_finite && std::isfinite(value);
  }
  for (const auto& block : blocks_) {
    for (const double value : block) is_finite = is_finite && std::isfinite(value);
  }
  if (!summary.IsSolutionUsable()) outcome.failure = "the solver failed: " + summary.message;
  if (!is_finite) outcome.failure = "the solution is not finite";
  // Copied element by element: Ceres holds the addresses.
  if (!outcome.failure.empty()) std::copy(backup.begin(), backup.end(), blocks_.begin());
  return outcome;
}

}  // namespace semantic_mht_slam
