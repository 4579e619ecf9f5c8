#pragma once

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/LU>

#include "semantic_mht_slam/mapping/odometry_stretch.h"

namespace semantic_mht_slam {

constexpr int kPoseNumbers = 3;  ///< numbers a pose or a step

/// landmark = point + J x: a detection carried to the stretch's frame by the pose of its keyframe, whose error is x.
template <int kDim>
struct Row {
  int keyframe = 0;
  Eigen::Matrix<double, kDim, 1> point_m;
  Eigen::Matrix<double, kDim, kPoseNumbers> J;
  Eigen::Matrix<double, kDim, kDim> information;
  double weight = 1.0;  ///< against wrong associations; `information` has it in it
};

/// Normal equations of all poses but the first, which is held, and how well the rows fit.
struct Equations {
  Eigen::MatrixXd H;
  Eigen::VectorXd g;  ///< gradient of half the squared error
  double squares = 0.0;
  double freedom = 0.0;
};

template <int kDim>
using Landmarks = std::vector<std::vector<Row<kDim>>>;

constexpr double kTrackCauchySigma = 2.0;

/// Weighted mean of the points of a landmark under Cauchy weights; the weights go into the rows.
template <int kDim>
Eigen::Matrix<double, kDim, 1> robustMean(std::vector<Row<kDim>>& rows) {
  Eigen::Matrix<double, kDim, 1> mean;
  for (int pass = 0; pass < 2; ++pass) {
    Eigen::Matrix<double, kDim, kDim> total = Eigen::Matrix<double, kDim, kDim>::Zero();
    Eigen::Matrix<double, kDim, 1> sum = Eigen::Matrix<double, kDim, 1>::Zero();
    for (std::size_t i = 0; i < rows.size(); ++i) {
      total += rows[i].weight * rows[i].information;
      sum += rows[i].weight * rows[i].information * rows[i].point_m;
    }
    mean = total.inverse() * sum;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const Eigen::Matrix<double, kDim, 1> d = rows[i].point_m - mean;
      rows[i].weight = 1.0 / (1.0 + d.dot(rows[i].information * d) / (kDim * kTrackCauchySigma * kTrackCauchySigma));
    }
  }
  for (Row<kDim>& row : rows) row.information *= row.weight;
  return mean;
}

/// One landmark, its position eliminated (Schur complement).
template <int kDim>
void addLandmark(std::vector<Row<kDim>> rows, Equations& all) {
  const Eigen::Matrix<double, kDim, 1> mean_m = robustMean<kDim>(rows);
  Eigen::Matrix<double, kDim, kDim> total = Eigen::Matrix<double, kDim, kDim>::Zero();
  std::map<int, Eigen::Matrix<double, kPoseNumbers, kDim>> cross;
  for (const Row<kDim>& row : rows) {
    const Eigen::Matrix<double, kDim, 1> d = row.point_m - mean_m;
    total += row.information;
    all.squares += d.dot(row.information * d);
    all.freedom += kDim * row.weight;
    if (row.keyframe == 0) continue;
    const int at = kPoseNumbers * (row.keyframe - 1);
    const Eigen::Matrix<double, kPoseNumbers, kDim> JtW = row.J.transpose() * row.information;
    all.H.block<kPoseNumbers, kPoseNumbers>(at, at) += JtW * row.J;
    all.g.segment<kPoseNumbers>(at) += JtW * d;
    auto [known, is_new] = cross.try_emplace(at, JtW);
    if (!is_new) known->second += JtW;
  }
  all.freedom -= kDim;
  const Eigen::Matrix<double, kDim, kDim> inverse = total.inverse();
  for (const auto& [a, of_a] : cross) {
    for (const auto& [b, of_b] : cross) {
      all.H.block<kPoseNumbers, kPoseNumbers>(a, b) -= of_a * inverse * of_b.transpose();
    }
  }
}

template <int kDim>
Equations equationsOf(const Landmarks<kDim>& landmarks, Eigen::Index size) {
  Equations all{Eigen::MatrixXd::Zero(size, size), Eigen::VectorXd::Zero(size), 0.0, 0.0};
  for (const auto& rows : landmarks) addLandmark<kDim>(rows, all);
  return all;
}

/// Observations of landmarks that two keyframes saw, by landmark.
inline std::vector<std::vector<const StretchObservation*>> tracksOf(const OdometryStretch& stretch) {
  std::map<LandmarkId, std::vector<const StretchObservation*>> by_landmark;
  for (const StretchObservation& observation : stretch.observations) {
    by_landmark[observation.landmark].push_back(&observation);
  }
  std::vector<std::vector<const StretchObservation*>> tracks;
  for (auto& [id, track] : by_landmark) {
    const bool is_from_two = std::any_of(track.begin(), track.end(), [first = track.front()](const auto* other) {
      return other->keyframe != first->keyframe;
    });
    if (is_from_two) tracks.push_back(std::move(track));
  }
  return tracks;
}

}  // namespace semantic_mht_slam
