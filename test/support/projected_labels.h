#pragma once

#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "semantic_mht_slam/io/text_file.h"
#include "semantic_mht_slam/models/camera.h"
#include "semantic_mht_slam/models/label_image.h"
#include "semantic_mht_slam/models/labelled_cloud.h"

namespace semantic_mht_slam {

/// Reads a painted scan: float32 x, y, z, class a point.
inline LabelledCloud readPaintedScan(const std::string& path) {
  const std::string content = readFile(path);
  LabelledCloud cloud;
  for (std::size_t at = 0; at + 16 <= content.size(); at += 16) {
    float values[4];
    std::memcpy(values, content.data() + at, sizeof(values));
    cloud.points_m.emplace_back(values[0], values[1], values[2]);
    cloud.labels.push_back(static_cast<std::uint16_t>(values[3]));
  }
  return cloud;
}

inline bool isSeen(const Eigen::Vector3f& point_m, const Camera& camera, int width_px, int height_px) {
  const auto pixel = camera.project(point_m.cast<double>());
  return pixel && pixel->minCoeff() >= 0.0 && pixel->x() <= width_px - 1.0 && pixel->y() <= height_px - 1.0;
}

/// A dense label image of a labelled cloud: each pixel takes the label of the nearest projected point within 6 px.
inline LabelImage projectLabels(const LabelledCloud& cloud, const Camera& camera, int width_px, int height_px,
                                std::uint16_t outside) {
  constexpr int kReach = 6;
  const auto pixels = static_cast<std::size_t>(width_px * height_px);
  LabelImage image{width_px, height_px, std::vector<std::uint16_t>(pixels, outside)};
  std::vector<double> nearest(pixels, std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (cloud.labels[i] == outside || !isSeen(cloud.points_m[i], camera, width_px, height_px)) continue;
    const Eigen::Vector2d seen = *camera.project(cloud.points_m[i].cast<double>());
    for (int dy = -kReach; dy <= kReach; ++dy) {
      for (int dx = -kReach; dx <= kReach; ++dx) {
        const int column = static_cast<int>(std::lround(seen.x())) + dx;
        const int row = static_cast<int>(std::lround(seen.y())) + dy;
        if (column < 0 || column >= width_px || row < 0 || row >= height_px) continue;
        const double distance = std::hypot(column - seen.x(), row - seen.y());
        const auto place = static_cast<std::size_t>(row * width_px + column);
        if (distance > kReach || distance >= nearest[place]) continue;
        nearest[place] = distance;
        image.labels[place] = cloud.labels[i];
      }
    }
  }
  return image;
}

}  // namespace semantic_mht_slam
