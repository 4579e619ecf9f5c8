#pragma once

#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "semantic_mht_slam/common/random.h"
#include "semantic_mht_slam/graph/pose_graph.h"

namespace semantic_mht_slam {

/// A drive through a town of square blocks, one node every 30 m, poles along the streets; the vehicle turns at
/// random, so that it comes back to old streets more and more often, from either direction. For tests and benchmarks.
struct SimulatedDrive {
  struct Step {
    Pose T_world_node;  ///< truth
    PoseNode node;
    std::vector<LoopConstraint> loops;
    std::vector<bool> is_wrong;  ///< per loop closure
  };
  std::vector<Step> steps;
  std::map<std::int64_t, Eigen::Vector3d> landmarks_m;  ///< truth, world frame
};

struct SimulatedDriveOptions {
  int nodes = 2000;
  int blocks = 14;                ///< streets per direction minus one
  double loop_prob = 0.5;         ///< that a place seen before is recognised
  double wrong_loop_prob = 0.05;  ///< per node
  double odometry_m = 0.16;       ///< standard deviation of one step
  double odometry_rad = 0.004;
  double sighting_m = 0.15;
  double loop_m = 0.15;
  double loop_rad = 0.005;
  bool resighted_landmarks = true;  ///< landmarks keep their number when a place was recognised
};

namespace simulated_drive_detail {

constexpr double kStep_m = 30.0;
constexpr int kStepsPerBlock = 4;

inline Pose planar(double x_m, double y_m, double heading_rad) {
  return {expRotation({0.0, 0.0, heading_rad}), {x_m, y_m, 0.5 * std::sin(0.01 * x_m)}};
}

inline Pose noise(Rng& rng, double stddev_m, double stddev_rad) {
  const Eigen::Vector3d turn(rng.normal(), rng.normal(), rng.normal());
  const Eigen::Vector3d move(rng.normal(), rng.normal(), rng.normal());
  return {expRotation(stddev_rad * turn), stddev_m * move};
}

inline PoseCov diagonalCov(double stddev_m, double stddev_rad) {
  PoseCov cov = PoseCov::Zero();
  cov.diagonal().head<3>().setConstant(stddev_m * stddev_m);
  cov.diagonal().tail<3>().setConstant(stddev_rad * stddev_rad);
  return cov;
}

/// True poses: straight along a block, then left, right or straight on, never out of town.
inline std::vector<Pose> drivePath(const SimulatedDriveOptions& options, Rng& rng) {
  std::vector<Pose> path;
  int x = 0;
  int y = 0;
  int direction = 0;
  const int dx[] = {1, 0, -1, 0};
  const int dy[] = {0, 1, 0, -1};
  const double block_m = kStep_m * kStepsPerBlock;
  while (static_cast<int>(path.size()) < options.nodes) {
    for (int i = 0; i < kStepsPerBlock; ++i) {
      path.push_back(planar(x * block_m + dx[direction] * i * kStep_m, y * block_m + dy[direction] * i * kStep_m,
                            direction * 0.5 * M_PI));
    }
    x += dx[direction];
    y += dy[direction];
    while (true) {
      const int turned = (direction + static_cast<int>(rng.index(3)) + 3) % 4;  // right, straight on, left
      const int next_x = x + dx[turned];
      const int next_y = y + dy[turned];
      if (next_x < 0 || next_y < 0 || next_x > options.blocks || next_y > options.blocks) continue;
      direction = turned;
      break;
    }
  }
  path.resize(options.nodes);
  return path;
}

/// Three poles around every place where a node can begin.
inline std::vector<std::int64_t> polesNear(const Eigen::Vector3d& position_m, SimulatedDrive& drive, Rng& rng) {
  std::vector<std::int64_t> ids;
  const int column = static_cast<int>(std::lround(position_m.x() / kStep_m));
  const int row = static_cast<int>(std::lround(position_m.y() / kStep_m));
  for (int i = -1; i <= 1; ++i) {
    for (int j = -1; j <= 1; ++j) {
      if (i * j != 0) continue;
      const int c = column + i;
      const int r = row + j;
      if (c % kStepsPerBlock != 0 && r % kStepsPerBlock != 0) continue;  // inside a block of houses
      for (int k = 0; k < 8; ++k) {
        const std::int64_t id = (static_cast<std::int64_t>(c + 1000) * 10000 + (r + 1000)) * 8 + k;
        Rng local = rng.fork("pole", static_cast<std::uint64_t>(id));
        drive.landmarks_m.try_emplace(id, c * kStep_m + local.uniform(-14.0, 14.0),
                                      r * kStep_m + local.uniform(-14.0, 14.0), local.uniform(-1.0, 2.0));
        ids.push_back(id);
      }
    }
  }
  return ids;
}

}  // namespace simulated_drive_detail

inline SimulatedDrive simulateDrive(const SimulatedDriveOptions& options, Rng& rng) {
  using namespace simulated_drive_detail;
  SimulatedDrive drive;
  const std::vector<Pose> path = drivePath(options, rng);
  std::map<std::pair<int, int>, std::vector<int>> visits;      // by place
  std::map<std::int64_t, std::pair<std::int64_t, int>> names;  // pole -> number given last and when it was last seen
  std::int64_t next_name = 0;
  std::map<std::int64_t, Eigen::Vector3d> named;
  for (int i = 0; i < static_cast<int>(path.size()); ++i) {
    SimulatedDrive::Step& step = drive.steps.emplace_back();
    step.T_world_node = path[i];
    step.node.odometry_cov = diagonalCov(options.odometry_m, options.odometry_rad);
    step.node.T_previous_node =
        i == 0 ? path[0] : path[i - 1].inverse() * path[i] * noise(rng, options.odometry_m, options.odometry_rad);
    const std::pair<int, int> place{static_cast<int>(std::lround(path[i].translation_m.x() / kStep_m)),
                                    static_cast<int>(std::lround(path[i].translation_m.y() / kStep_m))};
    const std::vector<int>& before = visits[place];
    const bool is_revisit = !before.empty() && i - before.back() > 10;
    const bool is_recognised = is_revisit && rng.bernoulli(options.loop_prob);
    if (is_recognised) {
      const int match = before[rng.index(before.size())];
      step.loops.push_back({i, match, path[i].inverse() * path[match] * noise(rng, options.loop_m, options.loop_rad),
                            diagonalCov(options.loop_m, options.loop_rad)});
      step.is_wrong.push_back(false);
    }
    if (i > 50 && rng.bernoulli(options.wrong_loop_prob)) {
      const int match = static_cast<int>(rng.index(i - 40));
      step.loops.push_back({i, match, noise(rng, 3.0, 0.3), diagonalCov(options.loop_m, options.loop_rad)});
      step.is_wrong.push_back((path[i].translation_m - path[match].translation_m).norm() > 15.0);
      if (!step.is_wrong.back()) {
        step.loops.pop_back();
        step.is_wrong.pop_back();
      }
    }
    visits[place].push_back(i);
    for (const std::int64_t pole : polesNear(path[i].translation_m, drive, rng)) {
      if (!rng.bernoulli(0.8)) continue;
      auto [name, is_new] = names.try_emplace(pole, next_name, i);
      const bool is_tracked = i - name->second.second <= 3;
      if (is_new || (!is_tracked && !(is_recognised && options.resighted_landmarks))) name->second.first = next_name++;
      name->second.second = i;
      const Eigen::Vector3d error(rng.normal(), rng.normal(), rng.normal());
      const Eigen::Vector3d& truth = drive.landmarks_m.at(pole);
      named[name->second.first] = truth;
      step.node.sightings.push_back({name->second.first, path[i].inverse() * truth + options.sighting_m * error,
                                     options.sighting_m * options.sighting_m * Eigen::Matrix3d::Identity()});
    }
  }
  drive.landmarks_m = named;
  return drive;
}

}  // namespace semantic_mht_slam
