#include "semantic_mht_slam/perception/vertical_structure.h"

#include <algorithm>
#include <bitset>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "semantic_mht_slam/common/saturated.h"

namespace semantic_mht_slam {
namespace {

constexpr float kColumn_m = 0.2F;          // wider than a beam's step at 50 m, narrower than the gap between two poles
constexpr int kLayers = 5;                 // of a cluster's height
constexpr std::size_t kLayersOfAxis = 4;   // that an axis fills
constexpr std::size_t kFewestPoints = 20;  // of a cluster that is worth splitting: two points a layer and axis

using ColumnIndex = std::pair<int, int>;

struct Column {
  std::bitset<kLayers> layers;
  Eigen::Vector2f sum_m = Eigen::Vector2f::Zero();
  int points = 0;
  bool is_taken = false;
};

using Columns = std::map<ColumnIndex, Column>;

struct Heights {
  float low_m;
  float high_m;
};

Heights heightsOf(const std::vector<Eigen::Vector3f>& points_m, const Cluster& cluster) {
  Heights heights{points_m[static_cast<std::size_t>(cluster.front())].z(), 0.0F};
  heights.high_m = heights.low_m;
  for (const int i : cluster) {
    heights.low_m = std::min(heights.low_m, points_m[static_cast<std::size_t>(i)].z());
    heights.high_m = std::max(heights.high_m, points_m[static_cast<std::size_t>(i)].z());
  }
  return heights;
}

/// The columns that reach through the cluster's height.
Columns uprightColumns(const std::vector<Eigen::Vector3f>& points_m, const Cluster& cluster) {
  const Heights heights = heightsOf(points_m, cluster);
  const float layers_per_m = kLayers / std::max(heights.high_m - heights.low_m, 1e-3F);
  Columns columns;
  for (const int i : cluster) {
    const Eigen::Vector3f& point = points_m[static_cast<std::size_t>(i)];
    Column& column =
        columns[{saturatedInt(std::floor(point.x() / kColumn_m)), saturatedInt(std::floor(point.y() / kColumn_m))}];
    const int layer = std::min(static_cast<int>((point.z() - heights.low_m) * layers_per_m), kLayers - 1);
    column.layers.set(static_cast<std::size_t>(layer));
    column.sum_m += point.head<2>();
    ++column.points;
  }
  for (auto column = columns.begin(); column != columns.end();) {
    column = column->second.layers.count() < kLayersOfAxis ? columns.erase(column) : std::next(column);
  }
  return columns;
}

/// Adds up a group of adjoining columns, from one of them.
Column collect(Columns& columns, const ColumnIndex& seed) {
  Column total;
  std::vector<ColumnIndex> waiting = {seed};
  while (!waiting.empty()) {
    const ColumnIndex at = waiting.back();
    waiting.pop_back();
    const auto found = columns.find(at);
    if (found == columns.end() || found->second.is_taken) continue;
    found->second.is_taken = true;
    total.sum_m += found->second.sum_m;
    total.points += found->second.points;
    for (int dx = -1; dx <= 1; ++dx) {
      for (int dy = -1; dy <= 1; ++dy) waiting.emplace_back(at.first + dx, at.second + dy);
    }
  }
  return total;
}

/// Where the upright things of a cluster stand.
std::vector<Eigen::Vector2f> findAxes(Columns columns, double split_distance_m) {
  std::vector<Eigen::Vector2f> axes_m;
  for (const auto& [at, column] : columns) {
    const Column group = collect(columns, at);
    if (group.points == 0) continue;  // belongs to a group before
    const Eigen::Vector2f axis = group.sum_m / static_cast<float>(group.points);
    const auto is_near = [&](const Eigen::Vector2f& other) { return (other - axis).norm() < split_distance_m; };
    if (std::none_of(axes_m.begin(), axes_m.end(), is_near)) axes_m.push_back(axis);
  }
  return axes_m;
}

/// A cluster as an upright stick.
struct Stick {
  Eigen::Vector2f axis_m = Eigen::Vector2f::Zero();
  Heights heights{};
};

Stick stickOf(const std::vector<Eigen::Vector3f>& points_m, const Cluster& cluster) {
  Stick stick;
  for (const int i : cluster) stick.axis_m += points_m[static_cast<std::size_t>(i)].head<2>();
  stick.axis_m /= static_cast<float>(cluster.size());
  stick.heights = heightsOf(points_m, cluster);
  return stick;
}

bool areOne(const Stick& a, const Stick& b, const VerticalConfig& config) {
  const float gap_m = std::max(a.heights.low_m, b.heights.low_m) - std::min(a.heights.high_m, b.heights.high_m);
  return (a.axis_m - b.axis_m).norm() <= config.merge_distance_m && gap_m <= config.merge_gap_m;
}

}  // namespace

std::vector<Cluster> splitByAxes(const std::vector<Eigen::Vector3f>& points_m, const Cluster& cluster,
                                 const VerticalConfig& config) {
  if (cluster.size() < kFewestPoints) return {cluster};
  const std::vector<Eigen::Vector2f> axes_m = findAxes(uprightColumns(points_m, cluster), config.split_distance_m);
  if (axes_m.size() < 2) return {cluster};
  std::vector<Cluster> parts(axes_m.size());
  for (const int i : cluster) {
    const Eigen::Vector2f point = points_m[static_cast<std::size_t>(i)].head<2>();
    const auto is_nearer = [&](const Eigen::Vector2f& a, const Eigen::Vector2f& b) {
      return (a - point).squaredNorm() < (b - point).squaredNorm();
    };
    const auto nearest = std::min_element(axes_m.begin(), axes_m.end(), is_nearer);
    parts[static_cast<std::size_t>(nearest - axes_m.begin())].push_back(i);
  }
  return parts;
}

std::vector<Cluster> mergeByAxes(const std::vector<Eigen::Vector3f>& points_m, const std::vector<Cluster>& clusters,
                                 const VerticalConfig& config) {
  std::vector<Stick> sticks;
  sticks.reserve(clusters.size());
  for (const Cluster& cluster : clusters) sticks.push_back(stickOf(points_m, cluster));
  std::vector<std::size_t> along_x(clusters.size());
  std::iota(along_x.begin(), along_x.end(), std::size_t{0});
  std::sort(along_x.begin(), along_x.end(), [&](std::size_t a, std::size_t b) {
    return std::pair(sticks[a].axis_m.x(), a) < std::pair(sticks[b].axis_m.x(), b);
  });

  std::vector<std::size_t> leader(clusters.size());
  std::iota(leader.begin(), leader.end(), std::size_t{0});
  const auto find = [&](std::size_t i) {
    while (leader[i] != i) i = leader[i];
    return i;
  };
  for (std::size_t i = 0; i < along_x.size(); ++i) {
    const Stick& a = sticks[along_x[i]];
    for (std::size_t j = i + 1; j < along_x.size(); ++j) {
      const Stick& b = sticks[along_x[j]];
      if (b.axis_m.x() - a.axis_m.x() > config.merge_distance_m) break;
      const std::size_t first = find(along_x[i]);
      const std::size_t second = find(along_x[j]);
      if (first != second && areOne(a, b, config)) leader[std::max(first, second)] = std::min(first, second);
    }
  }

  std::vector<Cluster> merged(clusters.size());
  for (std::size_t i = 0; i < clusters.size(); ++i) {
    Cluster& whole = merged[find(i)];
    whole.insert(whole.end(), clusters[i].begin(), clusters[i].end());
  }
  merged.erase(std::remove_if(merged.begin(), merged.end(), [](const Cluster& cluster) { return cluster.empty(); }),
               merged.end());
  for (Cluster& cluster : merged) std::sort(cluster.begin(), cluster.end());
  return merged;
}

}  // namespace semantic_mht_slam
