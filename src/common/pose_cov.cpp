#include "semantic_mht_slam/common/pose_cov.h"

#include "semantic_mht_slam/common/gaussian.h"

namespace semantic_mht_slam {
namespace {

constexpr double kUnknownVariance = 1e6;  // m^2 and rad^2

Eigen::Matrix<double, 6, 6> turnOf(const Pose& T_a_b) {
  const Eigen::Matrix3d R = T_a_b.rotation.toRotationMatrix();
  Eigen::Matrix<double, 6, 6> turn = Eigen::Matrix<double, 6, 6>::Zero();
  turn.topLeftCorner<3, 3>() = R;
  turn.bottomRightCorner<3, 3>() = R;
  return turn;
}

}  // namespace

FixedAxesCov inFixedAxes(const Pose& T_a_b, const PoseCov& cov) {
  const Eigen::Matrix<double, 6, 6> turn = turnOf(T_a_b);
  return symmetric(turn * cov * turn.transpose());
}

SharedErrors inFixedAxes(const Pose& T_a_b, const SharedErrors& errors) {
  return turnOf(T_a_b) * errors;
}

Eigen::Matrix<double, 6, 6> swing(const Eigen::Vector3d& lever_m) {
  Eigen::Matrix<double, 6, 6> matrix = Eigen::Matrix<double, 6, 6>::Identity();
  matrix.topRightCorner<3, 3>() = -skew(lever_m);
  return matrix;
}

FixedAxesCov carried(const FixedAxesCov& cov, const Eigen::Vector3d& lever_m) {
  const Eigen::Matrix<double, 6, 6> by_swing = swing(lever_m);
  return symmetric(by_swing * cov * by_swing.transpose());
}

FixedAxesCov unknownPoseCov() {
  return kUnknownVariance * FixedAxesCov::Identity();
}

}  // namespace semantic_mht_slam
