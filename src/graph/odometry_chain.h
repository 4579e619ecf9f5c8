#pragma once

#include <vector>

#include "semantic_mht_slam/common/dense_solvers.h"
#include "semantic_mht_slam/graph/batch_graph.h"

#include "tangent.h"

namespace semantic_mht_slam {

/// A relative pose and the covariance (order translation, rotation) of a step on its left.
template <int kDim>
struct UncertainLink {
  typename BatchGraph<kDim>::PoseType T_from_to;
  typename BatchGraph<kDim>::PoseInformation cov;
};

/// A measured relative pose whose covariance is that of its error e, a step on its right (see `BatchGraph`).
template <int kDim>
UncertainLink<kDim> measuredLink(const typename BatchGraph<kDim>::PoseType& T_from_to,
                                 const typename BatchGraph<kDim>::PoseInformation& cov) {
  const auto to_left = adjoint(T_from_to);
  return {T_from_to, to_left * cov * to_left.transpose()};
}

template <int kDim>
UncertainLink<kDim> reversedLink(const UncertainLink<kDim>& link) {
  const auto T_to_from = link.T_from_to.inverse();
  const auto turn = adjoint(T_to_from);
  return {T_to_from, turn * link.cov * turn.transpose()};
}

/// Relative poses along odometry with their covariances, any pair in constant time: the covariance of every pose is
/// summed up once as a step in the world frame, where the steps of successive stretches simply add.
template <int kDim>
class OdometryChain {
 public:
  using PoseType = typename BatchGraph<kDim>::PoseType;
  using Cov = typename BatchGraph<kDim>::PoseInformation;

  /// Adds a node that nothing joins to the one before.
  void startSegment() { nodes_.push_back({PoseType{}, Cov::Zero(), nodes_.empty() ? 0 : nodes_.back().segment + 1}); }

  /// Adds a node behind the last one; `cov` of the error e of the measured step.
  void append(const PoseType& T_last_new, const Cov& cov) {
    const Node& last = nodes_.back();
    const PoseType pose = last.pose * T_last_new;
    const auto to_world = adjoint(pose);
    nodes_.push_back({pose, last.cov + to_world * cov * to_world.transpose(), last.segment});
  }

  bool joins(int a, int b) const { return nodes_[a].segment == nodes_[b].segment; }

  UncertainLink<kDim> between(int from, int to) const {
    const PoseType T_from_world = nodes_[from].pose.inverse();
    const auto to_frame = adjoint(T_from_world);
    const Cov cov = from < to ? Cov(nodes_[to].cov - nodes_[from].cov) : Cov(nodes_[from].cov - nodes_[to].cov);
    return {T_from_world * nodes_[to].pose, to_frame * cov * to_frame.transpose()};
  }

 private:
  struct Node {
    PoseType pose;
    Cov cov;
    int segment;
  };
  std::vector<Node> nodes_;
};

/// A chain of links from a start to where it has come, with the covariance of all of it as a step at the start.
template <int kDim>
class Walk {
 public:
  Walk& along(const UncertainLink<kDim>& link) {
    const auto to_start = adjoint(reached_);
    cov_ += to_start * link.cov * to_start.transpose();
    reached_ = reached_ * link.T_from_to;
    return *this;
  }

  /// Mahalanobis distance squared of the end from the start; they should be the same place.
  double gap() const {
    const auto error = offset(reached_);
    return error.dot(solved(cov_, error));
  }

 private:
  typename BatchGraph<kDim>::PoseType reached_;
  typename BatchGraph<kDim>::PoseInformation cov_ = BatchGraph<kDim>::PoseInformation::Zero();
};

/// A loop closure ready for consistency tests.
template <int kDim>
struct TestedLoop {
  int from = 0;
  int to = 0;
  UncertainLink<kDim> forward;
  UncertainLink<kDim> backward;
};

template <int kDim>
TestedLoop<kDim> makeTestedLoop(int from, int to, const typename BatchGraph<kDim>::PoseType& T_from_to,
                                const typename BatchGraph<kDim>::PoseInformation& cov) {
  const auto forward = measuredLink<kDim>(T_from_to, cov);
  return {from, to, forward, reversedLink<kDim>(forward)};
}

/// Mahalanobis distance squared of a loop closure from odometry.
template <int kDim>
double gapToOdometry(const OdometryChain<kDim>& odometry, const TestedLoop<kDim>& loop) {
  return Walk<kDim>().along(loop.forward).along(odometry.between(loop.to, loop.from)).gap();
}

/// Mahalanobis distance squared of the cycle through two loop closures and the odometry between their ends.
template <int kDim>
double gapBetween(const OdometryChain<kDim>& odometry, const TestedLoop<kDim>& a, const TestedLoop<kDim>& b) {
  return Walk<kDim>()
      .along(a.forward)
      .along(odometry.between(a.to, b.to))
      .along(b.backward)
      .along(odometry.between(b.from, a.from))
      .gap();
}

}  // namespace semantic_mht_slam
