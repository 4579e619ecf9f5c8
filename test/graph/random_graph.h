#pragma once

#include "semantic_mht_slam/common/random.h"
#include "semantic_mht_slam/graph/batch_graph.h"

namespace semantic_mht_slam {

inline Pose randomStep(Rng& rng, double stddev_m, double stddev_rad, const Pose& mean) {
  const Eigen::Vector3d turn(rng.normal(), rng.normal(), rng.normal());
  const Eigen::Vector3d move(rng.normal(), rng.normal(), rng.normal());
  return mean * Pose{expRotation(stddev_rad * turn), stddev_m * move};
}

inline Pose2 randomStep(Rng& rng, double stddev_m, double stddev_rad, const Pose2& mean) {
  return mean * Pose2{stddev_m * Eigen::Vector2d(rng.normal(), rng.normal()), stddev_rad * rng.normal()};
}

inline Pose circleStep(const Pose*) {
  return {expRotation({0.02, 0.0, 2.0 * M_PI / 20.0}), {1.0, 0.0, 0.0}};
}
inline Pose2 circleStep(const Pose2*) {
  return {{1.0, 0.0}, 2.0 * M_PI / 20.0};
}

/// Two rounds of a circle with a loop closure at every pose of the second and some points; measurements with noise.
template <int kDim>
BatchGraph<kDim> randomGraph(Rng& rng, double stddev_m = 0.02, double stddev_rad = 0.01, int points = 0) {
  using Graph = BatchGraph<kDim>;
  using PoseType = typename Graph::PoseType;
  constexpr int kRound = 20;
  Graph graph;
  PoseType truth;
  std::vector<PoseType> truths;
  typename Graph::PoseInformation information = Graph::PoseInformation::Identity();
  information.diagonal().template head<kDim>().setConstant(1.0 / (stddev_m * stddev_m));
  information.diagonal().template tail<Graph::kDof - kDim>().setConstant(1.0 / (stddev_rad * stddev_rad));
  const auto measure = [&](int from, int to) {
    const PoseType exact = truths[from].inverse() * truths[to];
    graph.pose_edges.push_back({from, to, randomStep(rng, stddev_m, stddev_rad, exact), information});
  };
  for (int i = 0; i < 2 * kRound; ++i) {
    truths.push_back(truth);
    graph.poses.push_back({i, PoseType{}, false});
    truth = truth * circleStep(static_cast<const PoseType*>(nullptr));
    if (i > 0) measure(i - 1, i);
    if (i >= kRound) measure(i, i - kRound);
  }
  const double weight = 1.0 / (stddev_m * stddev_m);
  for (int k = 0; k < points; ++k) {
    graph.points.push_back({1000 + k, Graph::Point::Zero(), false});
    typename Graph::Point position;
    for (int i = 0; i < kDim; ++i) position[i] = rng.uniform(-5.0, 5.0);
    for (int i = k % 3; i < 2 * kRound; i += 3) {
      typename Graph::Point seen = truths[i].inverse() * position;
      for (int j = 0; j < kDim; ++j) seen[j] += stddev_m * rng.normal();
      graph.point_edges.push_back({i, k, seen, weight * Graph::PointInformation::Identity()});
    }
  }
  return graph;
}

}  // namespace semantic_mht_slam
