#include "marginals.h"

#include <algorithm>

#include "semantic_mht_slam/common/dense_solvers.h"
#include "semantic_mht_slam/common/gaussian.h"

namespace semantic_mht_slam {
namespace {

using PoseToPoint = Eigen::Matrix<double, 6, 3>;

double weightOf(const ceres::LossFunction* loss, double squared) {
  if (loss == nullptr) return 1.0;
  double rho[3];
  loss->Evaluate(squared, rho);
  return rho[1];
}

Matrix6d stepToError(const Pose& T_world_to) {
  Matrix6d by_step = Matrix6d::Zero();
  by_step.topRightCorner<3, 3>() = T_world_to.rotation.conjugate().toRotationMatrix();
  by_step.bottomLeftCorner<3, 3>().setIdentity();
  return by_step;
}

/// What sightings know of a landmark, and how they tie it to the nodes that saw it.
struct PointInformation {
  Eigen::Matrix3d own = Eigen::Matrix3d::Zero();
  std::vector<int> nodes;           ///< rising
  std::vector<PoseToPoint> ties;    ///< of each node
  std::vector<Matrix6d> of_nodes;   ///< what each sighting knows of its node
  Eigen::Matrix3d conditional_cov;  ///< if the nodes were known
};

PointInformation informationOf(const LandmarkState& landmark, const GraphState& graph,
                               const ceres::LossFunction& loss) {
  PointInformation result;
  const Eigen::Vector3d position_m = graph.landmarkInWorld(landmark);
  for (const SightingFactor& sighting : landmark.sightings) {
    const double* blocks[] = {graph.nodes[sighting.node].block.data(), position_m.data()};
    Eigen::Vector3d residual;
    RowMajor<3, 7> by_pose;
    RowMajor<3, 3> by_point;
    double* jacobians[] = {by_pose.data(), by_point.data()};
    sighting.cost->Evaluate(blocks, residual.data(), jacobians);
    const double weight = weightOf(&loss, residual.squaredNorm());
    const Eigen::Matrix<double, 3, 6> by_step = by_pose.leftCols<6>();
    if (result.nodes.empty() || result.nodes.back() != sighting.node) {
      result.nodes.push_back(sighting.node);
      result.ties.emplace_back(PoseToPoint::Zero());
      result.of_nodes.emplace_back(Matrix6d::Zero());
    }
    result.own += weight * by_point.transpose() * by_point;
    result.ties.back() += weight * by_step.transpose() * by_point;
    result.of_nodes.back() += weight * by_step.transpose() * by_step;
  }
  result.conditional_cov = symmetric(inverted(result.own));
  return result;
}

void addTo(PoseInformation& poses, const PointInformation& point) {
  for (std::size_t a = 0; a < point.nodes.size(); ++a) {
    const PoseToPoint weighted = point.ties[a] * point.conditional_cov;
    poses.add(point.nodes[a], point.nodes[a], point.of_nodes[a] - weighted * point.ties[a].transpose());
    for (std::size_t b = 0; b < a; ++b) {
      poses.add(point.nodes[a], point.nodes[b], -weighted * point.ties[b].transpose());
    }
  }
}

Eigen::Matrix3d covarianceOf(const PointInformation& point, const PoseInformation& poses) {
  Eigen::Matrix3d cov = Eigen::Matrix3d::Zero();
  for (std::size_t a = 0; a < point.nodes.size(); ++a) {
    cov += point.ties[a].transpose() * poses.stepCov(point.nodes[a], point.nodes[a]) * point.ties[a];
    for (std::size_t b = 0; b < a; ++b) {
      const Eigen::Matrix3d across =
          point.ties[a].transpose() * poses.stepCov(point.nodes[a], point.nodes[b]) * point.ties[b];
      cov += across + across.transpose();
    }
  }
  return symmetric(point.conditional_cov + point.conditional_cov * cov * point.conditional_cov);
}

bool takesPart(const LoopState3& loop) {
  return loop.state == LoopState::kAccepted && loop.is_reviewed;
}

std::vector<std::vector<int>> cliquesOf(const GraphState& graph, const std::vector<PointInformation>& points) {
  std::vector<std::vector<int>> cliques;
  for (int i = 1; i < graph.nodeCount(); ++i) cliques.push_back({i - 1, i});
  for (const LoopState3& loop : graph.loops) {
    if (takesPart(loop)) cliques.push_back({loop.constraint.from, loop.constraint.to});
  }
  for (const PointInformation& point : points) cliques.push_back(point.nodes);
  if (graph.outer.is_aligned) {
    for (const auto& factor : graph.outer.factors) cliques.push_back({factor.position.node, graph.nodeCount()});
  }
  return cliques;
}

}  // namespace

WhitenedRelation whiten(const RelativePose3Cost& cost, const ceres::LossFunction* loss, const double* from,
                        const double* to) {
  const double* blocks[] = {from, to};
  Vector6d residual;
  RowMajor<6, 7> by_from;
  RowMajor<6, 7> by_to;
  double* jacobians[] = {by_from.data(), by_to.data()};
  cost.Evaluate(blocks, residual.data(), jacobians);
  return {by_from.leftCols<6>(), by_to.leftCols<6>(), weightOf(loss, residual.squaredNorm())};
}

PoseCov errorCov(const Pose& T_world_to, const Eigen::MatrixXd& step_cov) {
  const Matrix6d by_step = stepToError(T_world_to);
  return by_step * step_cov * by_step.transpose();
}

SharedErrors sharedErrors(const Pose& T_world_to, const Eigen::MatrixXd& step) {
  return stepToError(T_world_to) * step;
}

PoseInformation::PoseInformation(int poses, const std::vector<std::vector<int>>& cliques)
    : cholesky_(std::max(0, poses - 1),
                [&] {
                  std::vector<std::vector<int>> variable(cliques.size());
                  for (std::size_t i = 0; i < cliques.size(); ++i) {
                    for (const int pose : cliques[i]) {
                      if (pose > 0) variable[i].push_back(pose - 1);
                    }
                  }
                  return variable;
                }()),
      gradient_(Eigen::MatrixXd::Zero(6 * std::max(0, poses - 1), kSharedErrors)) {}

void PoseInformation::add(int a, int b, const Matrix6d& information) {
  if (a > 0 && b > 0) cholesky_.add(a - 1, b - 1, information);
}

void PoseInformation::add(const RelativePose3Cost& cost, const ceres::LossFunction* loss, int from,
                          const double* from_block, int to, const double* to_block, const SharedErrors& shared) {
  const WhitenedRelation relation = whiten(cost, loss, from_block, to_block);
  add(from, from, relation.weight * relation.by_from.transpose() * relation.by_from);
  add(to, to, relation.weight * relation.by_to.transpose() * relation.by_to);
  add(from, to, relation.weight * relation.by_from.transpose() * relation.by_to);
  if (shared.isZero(0.0)) return;
  const SharedErrors whitened = relation.weight * cost.squareRoot() * shared;
  if (from > 0) gradient_.middleRows<6>(6 * (from - 1)) += relation.by_from.transpose() * whitened;
  if (to > 0) gradient_.middleRows<6>(6 * (to - 1)) += relation.by_to.transpose() * whitened;
}

bool PoseInformation::solve() {
  if (!cholesky_.factorize()) return false;
  gradient_ = cholesky_.solve(gradient_);
  cholesky_.invert();
  return gradient_.allFinite();
}

Matrix6d PoseInformation::ownStepCov(int a, int b) const {
  return a > 0 && b > 0 ? cholesky_.inverse(a - 1, b - 1) : Matrix6d(Matrix6d::Zero());
}

SharedErrors PoseInformation::sharedStep(int pose) const {
  return pose > 0 ? SharedErrors(gradient_.middleRows<6>(6 * (pose - 1))) : SharedErrors(SharedErrors::Zero());
}

std::optional<GraphMarginals> marginalsOf(const GraphState& graph, const PoseGraphConfig& config) {
  const ceres::CauchyLoss loop_loss(config.loop_cauchy_scale);
  const ceres::CauchyLoss landmark_loss(config.landmark_cauchy_scale);
  std::vector<PointInformation> points;
  for (const auto& [id, landmark] : graph.landmarks) points.push_back(informationOf(landmark, graph, landmark_loss));
  const int frame = graph.nodeCount();  // the outer one, behind the nodes
  PoseInformation poses(graph.outer.is_aligned ? frame + 1 : frame, cliquesOf(graph, points));
  const Pose origin = Pose::identity();
  std::array<double, kPoseBlock> world;
  writeBlock(origin, world.data());
  for (int i = 0; i < graph.nodeCount(); ++i) {
    const NodeState& node = graph.nodes[i];
    if (i > 0) {
      poses.add(*node.odometry_cost, nullptr, i - 1, graph.nodes[i - 1].block.data(), i, node.block.data(),
                node.shared_errors);
    }
    for (const PriorFactor& prior : node.priors) {
      poses.add(*prior.cost, nullptr, -1, world.data(), i, node.block.data(), SharedErrors::Zero());
    }
  }
  for (const LoopState3& loop : graph.loops) {
    if (!takesPart(loop)) continue;
    const int from = loop.constraint.from;
    const int to = loop.constraint.to;
    const ceres::LossFunction* loss = loop.constraint.is_certain ? nullptr : &loop_loss;
    poses.add(*loop.cost, loss, from, graph.nodes[from].block.data(), to, graph.nodes[to].block.data(),
              SharedErrors::Zero());
  }
  for (const PointInformation& point : points) addTo(poses, point);
  if (graph.outer.is_aligned) graph.outer.addTo(poses, frame, [&](int i) { return graph.nodes[i].block.data(); });
  if (!poses.solve()) return std::nullopt;
  GraphMarginals result;
  for (int i = 0; i < graph.nodeCount(); ++i) {
    result.poses.push_back(symmetric(errorCov(graph.nodes[i].pose(), poses.stepCov(i, i))));
  }
  auto point = points.begin();
  for (const auto& [id, landmark] : graph.landmarks) result.landmarks[id] = covarianceOf(*point++, poses);
  return result;
}

}  // namespace semantic_mht_slam
