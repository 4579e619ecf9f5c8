#pragma once

#include <cmath>
#include <ctime>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "simulated_drive.h"

namespace semantic_mht_slam {

/// A graph after a drive.
struct Driven {
  PoseGraph graph;
  std::vector<bool> is_wrong;  ///< per loop closure
  std::string failures;
  int out_of_time = 0;             ///< calls that a time budget ended
  std::vector<double> call_cpu_s;  ///< per node: processor time to add it and optimise
};

inline double processorSeconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

/// Adds every node with its loop closures and optimises after each.
inline Driven driveThrough(const SimulatedDrive& drive, const PoseGraphConfig& config = {}) {
  Driven driven{PoseGraph(config), {}, {}, 0, {}};
  for (const SimulatedDrive::Step& step : drive.steps) {
    const double start_s = processorSeconds();
    driven.graph.addNode(step.node);
    for (const LoopConstraint& loop : step.loops) driven.graph.addLoopClosure(loop);
    driven.is_wrong.insert(driven.is_wrong.end(), step.is_wrong.begin(), step.is_wrong.end());
    const PoseGraphUpdate update = driven.graph.optimize();
    driven.call_cpu_s.push_back(processorSeconds() - start_s);
    driven.failures += update.failure;
    driven.out_of_time += update.out_of_time ? 1 : 0;
  }
  return driven;
}

/// So few streets that each is driven many times.
inline SimulatedDriveOptions smallTown(int nodes) {
  SimulatedDriveOptions options;
  options.nodes = nodes;
  options.blocks = 3;
  return options;
}

/// Root of the mean squared distance from the true positions after rigid alignment, metres.
inline double alignedRmse(const std::vector<Pose>& poses, const SimulatedDrive& drive) {
  Eigen::Matrix3Xd estimate(3, poses.size());
  Eigen::Matrix3Xd truth(3, poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    estimate.col(static_cast<Eigen::Index>(i)) = poses[i].translation_m;
    truth.col(static_cast<Eigen::Index>(i)) = drive.steps[i].T_world_node.translation_m;
  }
  const Eigen::Matrix4d T = Eigen::umeyama(estimate, truth, false);
  const Eigen::Matrix3Xd error = ((T.topLeftCorner<3, 3>() * estimate).colwise() + T.topRightCorner<3, 1>()) - truth;
  return std::sqrt(error.colwise().squaredNorm().mean());
}

/// Poses from odometry alone.
inline std::vector<Pose> deadReckoning(const SimulatedDrive& drive) {
  std::vector<Pose> poses;
  for (const auto& step : drive.steps) {
    poses.push_back(poses.empty() ? step.node.T_previous_node : poses.back() * step.node.T_previous_node);
  }
  return poses;
}

}  // namespace semantic_mht_slam
