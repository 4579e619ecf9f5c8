#pragma once

#include <optional>

#include <Eigen/Core>

namespace semantic_mht_slam {

constexpr double kLogTwoPi = 1.8378770664093454836;

/// Normal distribution over R^3: mean in metres, covariance in square metres.
struct Gaussian3 {
  Eigen::Vector3d mean_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d cov_m2 = Eigen::Matrix3d::Identity();
};

/// A covariance that rounding has left not quite symmetric, symmetric again.
template <typename Derived>
typename Derived::PlainObject symmetric(const Eigen::MatrixBase<Derived>& covariance) {
  const typename Derived::PlainObject plain = covariance;
  return 0.5 * (plain + plain.transpose());
}

/// True if the matrix is finite, symmetric (relative 1e-9) and positive definite.
bool isCovariance(const Eigen::Matrix3d& matrix);

/// Squared Mahalanobis distance and log density (natural logarithm, 1/m^3) of `point_m`.
struct GaussianEvaluation {
  double mahalanobis_sq = 0.0;
  double log_density = 0.0;
};

/// Evaluates a Gaussian at a point; empty if the covariance is not positive definite.
std::optional<GaussianEvaluation> evaluate(const Gaussian3& gaussian, const Eigen::Vector3d& point_m);

}  // namespace semantic_mht_slam
