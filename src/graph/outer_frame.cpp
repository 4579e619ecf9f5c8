#include "outer_frame.h"

#include "semantic_mht_slam/common/dense_solvers.h"
#include "semantic_mht_slam/common/state_archive.h"
#include "semantic_mht_slam/common/state_checks.h"

#include "marginals.h"
#include "outer_alignment.h"

namespace semantic_mht_slam {
namespace {

constexpr double kFarthest_m = 1e8;
constexpr double kLeastVariance_m2 = 1e-8;
constexpr double kTiltStddev_rad = 0.035;  // of the first frame of a drive against the vertical

using PoseMap = Eigen::Map<const Eigen::Quaterniond>;

Eigen::Map<const Eigen::Vector3d> translationOf(const double* block) {
  return Eigen::Map<const Eigen::Vector3d>(block + 4);
}

template <int kRows>
using StepJacobian = Eigen::Matrix<double, kRows, 6>;

/// J^T J by steps, and what ties two blocks together.
template <int kRows>
Matrix6d product(const RowMajor<kRows, 7>& a, const RowMajor<kRows, 7>& b, double weight) {
  const StepJacobian<kRows> by_a = a.template leftCols<6>();
  const StepJacobian<kRows> by_b = b.template leftCols<6>();
  return weight * by_a.transpose() * by_b;
}

}  // namespace

OuterPointCost::OuterPointCost(const Eigen::Vector3d& in_node_m, const Eigen::Vector3d& measured_m,
                               const Eigen::Matrix3d& cov_m2)
    : in_node_m_(in_node_m), measured_m_(measured_m), sqrt_info_(upperSquareRoot(inverted(cov_m2))) {}

std::unique_ptr<OuterPointCost> OuterPointCost::seenFrom(const Pose& T_other_node) const {
  return std::unique_ptr<OuterPointCost>(
      new OuterPointCost(T_other_node * in_node_m_, measured_m_, SquareRoot<Eigen::Matrix3d>{sqrt_info_}));
}

bool OuterPointCost::Evaluate(double const* const* blocks, double* residuals, double** jacobians) const {
  const Eigen::Matrix3d outer_world = PoseMap(blocks[0]).toRotationMatrix();
  const Eigen::Matrix3d world_node = PoseMap(blocks[1]).toRotationMatrix();
  const Eigen::Vector3d in_world_m = world_node * in_node_m_ + translationOf(blocks[1]);
  const Eigen::Vector3d error = outer_world * in_world_m + translationOf(blocks[0]) - measured_m_;
  Eigen::Map<Eigen::Vector3d>(residuals).noalias() = sqrt_info_ * error;
  if (jacobians == nullptr) return true;
  const Eigen::Matrix3d whitened = sqrt_info_ * outer_world;
  if (jacobians[0] != nullptr) {
    Eigen::Map<RowMajor<3, 7>> by_frame(jacobians[0]);
    by_frame << -whitened * skew(in_world_m), sqrt_info_, Eigen::Vector3d::Zero();
  }
  if (jacobians[1] != nullptr) {
    Eigen::Map<RowMajor<3, 7>> by_node(jacobians[1]);
    by_node << -whitened * world_node * skew(in_node_m_), whitened, Eigen::Vector3d::Zero();
  }
  return true;
}

bool TiltCost::Evaluate(double const* const* blocks, double* residuals, double** jacobians) const {
  const Eigen::Matrix3d outer_world = PoseMap(blocks[0]).toRotationMatrix();
  Eigen::Map<Eigen::Vector2d>(residuals).noalias() = outer_world.col(2).head<2>() / kTiltStddev_rad;
  if (jacobians == nullptr || jacobians[0] == nullptr) return true;
  Eigen::Map<RowMajor<2, 7>> by_frame(jacobians[0]);
  by_frame.setZero();
  const Eigen::Matrix3d by_turn = -outer_world * skew(Eigen::Vector3d(Eigen::Vector3d::UnitZ()));
  by_frame.leftCols<3>() = by_turn.topRows<2>() / kTiltStddev_rad;
  return true;
}

void OuterFrame::addTo(ceres::Problem& problem, const BlockOf& block_of) {
  problem.AddParameterBlock(block.data(), kPoseBlock);
  setManifold(problem, block.data(), &manifold);
  problem.AddResidualBlock(&tilt, nullptr, block.data());
  for (const Factor& factor : factors) {
    problem.AddResidualBlock(factor.cost.get(), &loss, block.data(), block_of(factor.position.node));
  }
}

void OuterFrame::addTo(PoseInformation& poses, int frame,
                       const std::function<const double*(int node)>& block_of) const {
  const double* frame_block = block.data();
  Eigen::Vector2d tilted;
  RowMajor<2, 7> by_tilt;
  double* tilt_jacobian = by_tilt.data();
  tilt.Evaluate(&frame_block, tilted.data(), &tilt_jacobian);
  poses.add(frame, frame, product<2>(by_tilt, by_tilt, 1.0));
  for (const Factor& factor : factors) {
    const int node = factor.position.node;
    const double* blocks[] = {frame_block, block_of(node)};
    Eigen::Vector3d residual;
    RowMajor<3, 7> by_frame;
    RowMajor<3, 7> by_node;
    double* jacobians[] = {by_frame.data(), by_node.data()};
    factor.cost->Evaluate(blocks, residual.data(), jacobians);
    double rho[3];
    loss.Evaluate(residual.squaredNorm(), rho);
    poses.add(frame, frame, product<3>(by_frame, by_frame, rho[1]));
    poses.add(node, node, product<3>(by_node, by_node, rho[1]));
    poses.add(frame, node, product<3>(by_frame, by_node, rho[1]));
  }
}

double OuterFrame::distanceSq(const Factor& factor, const double* node_block) const {
  const double* blocks[] = {block.data(), node_block};
  Eigen::Vector3d residual;
  factor.cost->Evaluate(blocks, residual.data(), nullptr);
  return residual.squaredNorm();
}

std::optional<Pose> OuterFrame::T_outer_world() const {
  if (!is_aligned) return std::nullopt;
  Pose pose;
  readBlock(block.data(), pose);
  return pose;
}

void OuterFrame::transfer(StateArchive& archive, int nodes) {
  archive(is_aligned, block);
  Pose pose;
  readBlock(block.data(), pose);
  archive.require(pose.isValid() && pose.translation_m.norm() <= kFarthest_m, "a frame of fixes whose pose is none");
  const std::size_t count = archive.count(factors.size(), sizeof(Factor) + sizeof(OuterPointCost));
  for (std::size_t i = 0; i < count; ++i) {
    OuterPosition position = archive.isReading() ? OuterPosition{} : factors[i].position;
    archive(position.node, position.in_node_m, position.measured_m, position.cov_m2);
    archive.require(position.node >= 0 && position.node < nodes, "a fix of a keyframe that there is not");
    archive.require(isPositive(position.cov_m2) && position.cov_m2.diagonal().minCoeff() >= kLeastVariance_m2,
                    "a fix whose covariance is not positive, or next to nothing");
    archive.require(position.measured_m.norm() <= kFarthest_m && position.in_node_m.norm() <= kFarthest_m,
                    "a fix that is not on the Earth");
    if (archive.isReading()) add(position, *this);
  }
  archive.require(!is_aligned || factors.size() >= kFewestPairs, "a frame of fixes that these do not determine");
}

void add(const OuterPosition& position, OuterFrame& frame) {
  frame.factors.push_back(
      {position, std::make_unique<OuterPointCost>(position.in_node_m, position.measured_m, position.cov_m2)});
}

}  // namespace semantic_mht_slam
