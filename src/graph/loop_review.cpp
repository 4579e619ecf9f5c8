#include "loop_review.h"

#include <algorithm>

#include <Eigen/Cholesky>

#include "semantic_mht_slam/common/max_clique.h"

namespace semantic_mht_slam {
namespace {

constexpr long kCliqueSteps = 500;

}  // namespace

double mahalanobisSq(const GraphState& graph, const LoopConstraint& loop) {
  const Vector6d error = edgeError(graph.nodes[loop.from].pose(), graph.nodes[loop.to].pose(), loop.T_from_to);
  return error.dot(loop.cov.llt().solve(error));
}

void LoopReview::extendOdometry(const Pose& T_previous_node, const PoseCov& cov, bool is_first) {
  if (is_first) {
    odometry_.startSegment();
  } else {
    odometry_.append(T_previous_node, config_.odometry_cov_scale * cov);
  }
}

UncertainLink<3> LoopReview::estimatedLink(const GraphState& graph, int from, int to) const {
  return {graph.nodes[from].pose().inverse() * graph.nodes[to].pose(), odometry_.between(from, to).cov};
}

bool LoopReview::fitsOdometry(const GraphState& graph, const LoopConstraint& constraint) const {
  const TestedLoop<3> loop = makeTestedLoop<3>(constraint.from, constraint.to, constraint.T_from_to, constraint.cov);
  if (gapToOdometry(odometry_, loop) <= config_.loop_gate) return true;
  return Walk<3>().along(loop.forward).along(estimatedLink(graph, loop.to, loop.from)).gap() <= config_.loop_gate;
}

bool LoopReview::agree(const GraphState& graph, const TestedLoop<3>& a, const TestedLoop<3>& b) const {
  if (gapBetween(odometry_, a, b) <= config_.loop_gate) return true;
  return Walk<3>()
             .along(a.forward)
             .along(estimatedLink(graph, a.to, b.to))
             .along(b.backward)
             .along(estimatedLink(graph, b.from, a.from))
             .gap() <= config_.loop_gate;
}

void LoopReview::add(const GraphState& graph, const LoopConstraint& constraint) {
  const TestedLoop<3> loop = makeTestedLoop<3>(constraint.from, constraint.to, constraint.T_from_to, constraint.cov);
  const int count = graph.loopCount() - 1;  // without this one
  std::vector<bool>& agrees = agrees_.emplace_back();
  for (int other = count - 1; other >= std::max(0, count - config_.compared_loops); --other) {
    agrees.push_back(agree(graph, loop, loops_[other]));
  }
  fits_odometry_.push_back(fitsOdometry(graph, constraint));
  loops_.push_back(loop);
}

/// The newest loop closures that may agree with each other.
std::vector<int> LoopReview::candidates(const GraphState& graph) const {
  std::vector<int> result;
  const int count = graph.loopCount();
  for (int i = firstOpen(graph); i < count; ++i) {
    const LoopState state = graph.loops[i].state;
    if (graph.loops[i].constraint.is_certain) continue;
    if (state == LoopState::kAccepted || state == LoopState::kInconsistent) result.push_back(i);
  }
  return result;
}

void LoopReview::decide(GraphState& graph) {
  const int count = graph.loopCount();
  if (reviewed_ == count) return;
  for (; reviewed_ < count; ++reviewed_) {
    LoopState3& loop = graph.loops[reviewed_];
    const bool is_in = fits_odometry_[reviewed_] || loop.constraint.is_certain;
    if (loop.state != LoopState::kRemoved) {
      loop.state = is_in ? LoopState::kAccepted : LoopState::kContradictsOdometry;
    }
    loop.is_reviewed = true;
  }
  const std::vector<int> tested = candidates(graph);
  const std::vector<bool> chosen = largestAgreement(tested);
  for (std::size_t i = 0; i < tested.size(); ++i) {
    LoopState3& loop = graph.loops[tested[i]];
    if (chosen[i]) loop.is_readmitted = false;
    loop.state = chosen[i] || loop.is_readmitted ? LoopState::kAccepted : LoopState::kInconsistent;
  }
}

/// Which of `loops`, ascending, are in their largest set that agrees. Those that agree with all others are in every
/// such set, and mostly that is all of them: the search is for the rest.
std::vector<bool> LoopReview::largestAgreement(const std::vector<int>& loops) const {
  const auto disagree = [&](std::size_t newer, std::size_t older) {
    return !agrees_[loops[newer]][loops[newer] - loops[older] - 1];
  };
  std::vector<bool> chosen(loops.size(), true);
  for (std::size_t newer = 0; newer < loops.size(); ++newer) {
    for (std::size_t older = 0; older < newer; ++older) {
      if (disagree(newer, older)) chosen[newer] = chosen[older] = false;
    }
  }
  std::vector<std::size_t> contested;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    if (!chosen[i]) contested.push_back(i);
  }
  BitGraph agreement(static_cast<int>(contested.size()));
  for (int newer = 0; newer < agreement.size(); ++newer) {
    for (int older = 0; older < newer; ++older) {
      if (!disagree(contested[newer], contested[older])) agreement.join(newer, older);
    }
  }
  for (const int node : maximumClique(agreement, kCliqueSteps)) chosen[contested[node]] = true;
  return chosen;
}

void LoopReview::compareWithEstimate(GraphState& graph, const std::function<double(int)>& gap) const {
  const int count = graph.loopCount();
  for (int i = firstOpen(graph); i < count; ++i) {
    LoopState3& loop = graph.loops[i];
    if (!loop.is_reviewed || loop.constraint.is_certain || loop.state == LoopState::kRemoved) continue;
    const double distance = gap(i);
    if (loop.state == LoopState::kAccepted) {
      if (distance <= kSwitchOffFactor * config_.loop_gate) continue;
      loop.state = LoopState::kDoesNotFit;
      loop.is_readmitted = false;
    } else if (distance <= config_.loop_gate) {
      loop.state = LoopState::kAccepted;
      loop.is_readmitted = true;
    }
  }
}

PoseCov LoopReview::odometryCov(int from, int to) const {
  const UncertainLink<3> link = odometry_.between(from, to);
  const Matrix6d to_right = adjoint(link.T_from_to.inverse());
  return to_right * link.cov * to_right.transpose();
}

}  // namespace semantic_mht_slam
