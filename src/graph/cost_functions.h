#pragma once

#include <ceres/sized_cost_function.h>

#include "semantic_mht_slam/common/dense_solvers.h"
#include "semantic_mht_slam/common/pose.h"

#include "edge_residuals.h"

namespace semantic_mht_slam {

/// The upper square root of an information matrix itself, for a cost that is made again from what it was.
template <class Matrix>
struct SquareRoot {
  Matrix upper;
};

template <int kRows, int kCols>
using RowMajor = Eigen::Matrix<double, kRows, kCols, (kCols == 1 ? Eigen::ColMajor : Eigen::RowMajor)>;

/// Relative pose in the plane; blocks x y heading.
class RelativePose2Cost final : public ceres::SizedCostFunction<3, 3, 3> {
 public:
  RelativePose2Cost(const Pose2& measured, const Eigen::Matrix3d& information)
      : measured_(measured), sqrt_info_(upperSquareRoot(information)) {}

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override {
    const auto relative = relativeError(blocks[0], blocks[1], measured_);
    const auto weight = sqrt_info_.triangularView<Eigen::Upper>();
    Eigen::Map<Eigen::Vector3d>(residuals).noalias() = weight * relative.error;
    if (jacobians == nullptr) return true;
    if (jacobians[0] != nullptr) Eigen::Map<RowMajor<3, 3>>(jacobians[0]).noalias() = sqrt_info_ * relative.by_from;
    if (jacobians[1] != nullptr) Eigen::Map<RowMajor<3, 3>>(jacobians[1]).noalias() = sqrt_info_ * relative.by_to;
    return true;
  }

 private:
  Pose2 measured_;
  Eigen::Matrix3d sqrt_info_;
};

/// Relative pose in space; blocks of `PoseManifold`.
class RelativePose3Cost final : public ceres::SizedCostFunction<6, 7, 7> {
 public:
  RelativePose3Cost(const Pose& measured, const Matrix6d& information)
      : measured_(measured), sqrt_info_(upperSquareRoot(information)) {}
  RelativePose3Cost(const Pose& measured, const SquareRoot<Matrix6d>& root)
      : measured_(measured), sqrt_info_(root.upper) {}

  const Pose& measured() const { return measured_; }
  const Matrix6d& squareRoot() const { return sqrt_info_; }

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override {
    const auto relative = relativeError(blocks[0], blocks[1], measured_.rotation, measured_.translation_m);
    Eigen::Map<Vector6d>(residuals).noalias() = sqrt_info_ * relative.error;
    if (jacobians == nullptr) return true;
    if (jacobians[0] != nullptr) write(relative.by_from, jacobians[0]);
    if (jacobians[1] != nullptr) write(relative.by_to, jacobians[1]);
    return true;
  }

 private:
  void write(const Matrix6d& derivative, double* jacobian) const {
    Eigen::Map<RowMajor<6, 7>> result(jacobian);
    result.leftCols<6>().noalias() = sqrt_info_ * derivative;
    result.col(6).setZero();
  }

  Pose measured_;
  Matrix6d sqrt_info_;
};

/// Point seen from a pose; kDim 2 or 3, blocks as above and the point.
template <int kDim>
class PointCost final : public ceres::SizedCostFunction<kDim, (kDim == 2 ? 3 : 7), kDim> {
 public:
  using Point = Eigen::Matrix<double, kDim, 1>;
  using Matrix = Eigen::Matrix<double, kDim, kDim>;
  static constexpr int kBlock = kDim == 2 ? 3 : 7;
  static constexpr int kDof = kDim == 2 ? 3 : 6;

  PointCost(const Point& measured_m, const Matrix& information)
      : measured_m_(measured_m), sqrt_info_(upperSquareRoot(information)) {}
  PointCost(const Point& measured_m, const SquareRoot<Matrix>& root)
      : measured_m_(measured_m), sqrt_info_(root.upper) {}

  const Point& measured() const { return measured_m_; }
  const Matrix& squareRoot() const { return sqrt_info_; }

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override {
    const auto seen = pointError(blocks[0], blocks[1], measured_m_);
    Eigen::Map<Point>(residuals).noalias() = sqrt_info_ * seen.error;
    if (jacobians == nullptr) return true;
    if (jacobians[0] != nullptr) {
      Eigen::Map<RowMajor<kDim, kBlock>> by_pose(jacobians[0]);
      by_pose.setZero();
      by_pose.template leftCols<kDof>().noalias() = sqrt_info_ * seen.by_pose;
    }
    if (jacobians[1] != nullptr) {
      Eigen::Map<RowMajor<kDim, kDim>>(jacobians[1]).noalias() = sqrt_info_ * seen.by_point;
    }
    return true;
  }

 private:
  Point measured_m_;
  Matrix sqrt_info_;
};

/// What is known about a point in the frame of its block.
class PointPriorCost final : public ceres::SizedCostFunction<3, 3> {
 public:
  PointPriorCost(const Eigen::Vector3d& expected_m, const Eigen::Matrix3d& information)
      : expected_m_(expected_m), sqrt_info_(upperSquareRoot(information)) {}

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override {
    Eigen::Map<Eigen::Vector3d>(residuals).noalias() =
        sqrt_info_ * (Eigen::Map<const Eigen::Vector3d>(blocks[0]) - expected_m_);
    if (jacobians == nullptr || jacobians[0] == nullptr) return true;
    Eigen::Map<RowMajor<3, 3>> by_point(jacobians[0]);
    by_point = sqrt_info_;
    return true;
  }

 private:
  Eigen::Vector3d expected_m_;
  Eigen::Matrix3d sqrt_info_;
};

}  // namespace semantic_mht_slam
