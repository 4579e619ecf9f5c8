#pragma once

#include <Eigen/Core>

namespace semantic_mht_slam {

/// Covariance of the error of a relative pose T_from_to: order translation (m), rotation (rad), both in the frame `to`,
/// the error being a small step on the right of the measurement.
using PoseCov = Eigen::Matrix<double, 6, 6>;

}  // namespace semantic_mht_slam
