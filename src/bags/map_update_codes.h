#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <Eigen/Core>

// How numbers are packed in `MapUpdate`; see the messages.
namespace semantic_mht_slam {

constexpr double kMostSteps = 32767.0;  // of what is an int16
constexpr double kRotationStep_rad = M_PI / kMostSteps;
constexpr double kCorrelationSteps = 127.0;
constexpr int kCodeOfStep = 32;
constexpr double kCodesPerOctave = 8.0;

template <class Array>
void writeSteps(const Eigen::Vector3d& vector, double step, Array& to) {
  for (std::size_t i = 0; i < 3; ++i) {
    const double steps = std::round(vector[static_cast<Eigen::Index>(i)] / step);
    to[i] = static_cast<std::int16_t>(std::clamp(steps, -kMostSteps, kMostSteps));
  }
}

template <class Array>
Eigen::Vector3d readSteps(const Array& from, double step) {
  return step * Eigen::Vector3d(from[0], from[1], from[2]);
}

inline std::uint8_t codeOf(double variance_m2, double step_m) {
  const double octaves = 0.5 * std::log2(std::max(variance_m2, 1e-12)) - std::log2(step_m);
  return static_cast<std::uint8_t>(std::clamp(std::round(kCodeOfStep + kCodesPerOctave * octaves), 0.0, 255.0));
}

inline double varianceOf(std::uint8_t code, double step_m) {
  const double stddev_m = step_m * std::exp2((code - kCodeOfStep) / kCodesPerOctave);
  return stddev_m * stddev_m;
}

/// Axes away from the base, across, up, as columns, where something is seen.
inline Eigen::Matrix3d axesAt(const Eigen::Vector3d& position_m) {
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  const double distance_m = position_m.head<2>().norm();
  if (distance_m < 1e-6) return axes;
  const Eigen::Vector2d away = position_m.head<2>() / distance_m;
  axes.col(0) << away, 0.0;
  axes.col(1) << -away.y(), away.x(), 0.0;
  return axes;
}

}  // namespace semantic_mht_slam
