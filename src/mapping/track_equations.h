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
struct TrackRow {
  int keyframe = 0;
  Eigen::Matrix<double, kDim, 1> point_m;
  Eigen::Matrix<double, kDim, kPoseNumbers> J;
  Eigen::Matrix<double, kDim, 1> eye_m = Eigen::Matrix<double, kDim, 1>::Zero();  ///< where it was seen from
  Eigen::Matrix<double, kDim, kDim> information;
  double weight = 1.0;  ///< against wrong associations; `information` has it in it
};

/// Normal equations of all poses but the first, which is held, and of the errors of the ranges, which come last; and
/// how well the rows fit.
struct Equations {
  Eigen::MatrixXd H;
  Eigen::VectorXd g;  ///< gradient of half the squared error
  double squares = 0.0;
  double freedom = 0.0;
};

template <int kDim>
using Landmarks = std::vector<std::vector<TrackRow<kDim>>>;

constexpr double kTrackCauchySigma = 2.0;
constexpr double kLeastRange_m = 1e-3;

/// Weighted mean of the points of a landmark under Cauchy weights; the weights go into the rows.
template <int kDim>
Eigen::Matrix<double, kDim, 1> robustMean(std::vector<TrackRow<kDim>>& rows) {
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
  for (TrackRow<kDim>& row : rows) row.information *= row.weight;
  return mean;
}

/// How far a point is shown from where it is by a unit of each error that all ranges have in common; heights tell
/// nothing of these. The line of sight is that to the landmark: the detection's own has its noise in it.
template <int kDim>
Eigen::Matrix<double, kDim, kRangeErrors> rangeEffect(const TrackRow<kDim>& row,
                                                      const Eigen::Matrix<double, kDim, 1>& landmark_m) {
  Eigen::Matrix<double, kDim, kRangeErrors> effect = Eigen::Matrix<double, kDim, kRangeErrors>::Zero();
  if (kDim == 1) return effect;
  effect.col(0) = landmark_m - row.eye_m;
  effect.col(1) = effect.col(0) / std::max(effect.col(0).norm(), kLeastRange_m);
  return effect;
}

/// One landmark, its position eliminated (Schur complement).
template <int kDim>
void addLandmark(std::vector<TrackRow<kDim>> rows, Equations& all) {
  const Eigen::Matrix<double, kDim, 1> mean_m = robustMean<kDim>(rows);
  Eigen::Matrix<double, kDim, kDim> total = Eigen::Matrix<double, kDim, kDim>::Zero();
  std::map<int, Eigen::Matrix<double, kPoseNumbers, kDim>> cross;
  Eigen::Matrix<double, kRangeErrors, kDim> cross_bias = Eigen::Matrix<double, kRangeErrors, kDim>::Zero();
  Eigen::Matrix<double, kDim, 1> sum = Eigen::Matrix<double, kDim, 1>::Zero();
  const Eigen::Index at_bias = all.g.size() - kRangeErrors;
  for (const TrackRow<kDim>& row : rows) {
    const Eigen::Matrix<double, kDim, 1> d = row.point_m - mean_m;
    total += row.information;
    sum += row.information * d;
    all.squares += d.dot(row.information * d);
    all.freedom += kDim * row.weight;
    const Eigen::Matrix<double, kDim, kRangeErrors> effect = rangeEffect<kDim>(row, mean_m);
    const Eigen::Matrix<double, kRangeErrors, kDim> BtW = -effect.transpose() * row.information;
    all.H.bottomRightCorner<kRangeErrors, kRangeErrors>() -= BtW * effect;
    all.g.tail<kRangeErrors>() += BtW * d;
    cross_bias += BtW;
    if (row.keyframe == 0) continue;
    const int at = kPoseNumbers * (row.keyframe - 1);
    const Eigen::Matrix<double, kPoseNumbers, kDim> JtW = row.J.transpose() * row.information;
    all.H.block<kPoseNumbers, kPoseNumbers>(at, at) += JtW * row.J;
    all.H.block<kPoseNumbers, kRangeErrors>(at, at_bias) -= JtW * effect;
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
    all.H.block<kPoseNumbers, kRangeErrors>(a, at_bias) -= of_a * inverse * cross_bias.transpose();
    all.g.segment<kPoseNumbers>(a) -= of_a * inverse * sum;
  }
  all.H.bottomRightCorner<kRangeErrors, kRangeErrors>() -= cross_bias * inverse * cross_bias.transpose();
  all.g.tail<kRangeErrors>() -= cross_bias * inverse * sum;
}

/// `size` numbers of poses.
template <int kDim>
Equations equationsOf(const Landmarks<kDim>& landmarks, Eigen::Index size) {
  size += kRangeErrors;
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
