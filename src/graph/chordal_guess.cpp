#include <algorithm>
#include <deque>

#include <Eigen/Cholesky>
#include <Eigen/SVD>
#include <Eigen/SparseCholesky>

#include "semantic_mht_slam/graph/initial_guess.h"

namespace semantic_mht_slam {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

template <int kDim>
int heldPose(const BatchGraph<kDim>& graph) {
  return graph.fixed_poses.empty() ? 0 : graph.fixed_poses.front();
}

Eigen::Matrix2d rotationMatrix(const Pose2& pose) {
  return pose.rotationMatrix();
}
Eigen::Matrix3d rotationMatrix(const Pose& pose) {
  return pose.rotation.toRotationMatrix();
}

Pose2 makePose(const Eigen::Matrix2d& rotation, const Eigen::Vector2d& translation_m) {
  return {translation_m, std::atan2(rotation(1, 0), rotation(0, 0))};
}
Pose makePose(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& translation_m) {
  return {Eigen::Quaterniond(rotation).normalized(), translation_m};
}

/// The rotation nearest to a matrix in the Frobenius norm.
template <int kDim>
Eigen::Matrix<double, kDim, kDim> nearestRotation(const Eigen::Matrix<double, kDim, kDim>& matrix) {
  using Matrix = Eigen::Matrix<double, kDim, kDim>;
  const Eigen::JacobiSVD<Matrix> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Matrix u = svd.matrixU();
  if ((u * svd.matrixV().transpose()).determinant() < 0.0) u.col(kDim - 1) *= -1.0;
  return u * svd.matrixV().transpose();
}

/// One weight for a block of an information matrix: the harmonic mean of its eigenvalues, that is, the weight of the
/// direction that is known worst counts most.
template <class Block>
double scalarWeight(const Block& block) {
  const auto matrix = block.eval();
  return static_cast<double>(matrix.rows()) / matrix.inverse().trace();
}

/// Normal equations of  sum_e w_e | x_to - M_e^T x_from |^2  with x of the held pose known; M orthogonal, so that the
/// diagonal blocks are multiples of the identity.
template <int kBlock>
class RelaxedProblem {
 public:
  using Block = Eigen::Matrix<double, kBlock, kBlock>;
  using Values = Eigen::Matrix<double, Eigen::Dynamic, kBlock>;  // one column a right-hand side

  RelaxedProblem(int vertices, int held, int right_hand_sides)
      : vertices_(vertices),
        held_(held),
        weights_(vertices, 0.0),
        rhs_(Eigen::MatrixXd::Zero(kBlock * (vertices - 1), right_hand_sides)) {}

  /// Adds w | x_to - M^T x_from - offset |^2.
  void add(int from, int to, double weight, const Block& matrix, const Eigen::MatrixXd& offset,
           const Eigen::MatrixXd& held_value) {
    weights_[from] += weight;
    weights_[to] += weight;
    if (from != held_ && to != held_) {
      addBlock(row(from), row(to), -weight * matrix);
    }
    if (to != held_) {
      rhs_.middleRows(row(to), kBlock) += weight * offset;
      if (from == held_) rhs_.middleRows(row(to), kBlock) += weight * (matrix.transpose() * held_value);
    }
    if (from != held_) {
      rhs_.middleRows(row(from), kBlock) -= weight * (matrix * offset);
      if (to == held_) rhs_.middleRows(row(from), kBlock) += weight * (matrix * held_value);
    }
  }

  std::optional<Eigen::MatrixXd> solve() {
    for (int vertex = 0; vertex < vertices_; ++vertex) {
      if (vertex != held_) addDiagonal(row(vertex), weights_[vertex]);
    }
    Sparse matrix(rhs_.rows(), rhs_.rows());
    matrix.setFromTriplets(entries_.begin(), entries_.end());
    const Eigen::SimplicialLLT<Sparse, Eigen::Upper> factor(matrix);
    if (factor.info() != Eigen::Success) return std::nullopt;
    Eigen::MatrixXd solution = factor.solve(rhs_);
    if (!solution.allFinite()) return std::nullopt;
    return solution;
  }

  int row(int vertex) const { return kBlock * (vertex < held_ ? vertex : vertex - 1); }

 private:
  /// Block (a, b) of the upper triangle, transposed if it would fall below.
  void addBlock(int row_a, int row_b, const Block& block) {
    for (int i = 0; i < kBlock; ++i) {
      for (int j = 0; j < kBlock; ++j) {
        if (row_a < row_b) {
          entries_.emplace_back(row_a + i, row_b + j, block(i, j));
        } else {
          entries_.emplace_back(row_b + j, row_a + i, block(i, j));
        }
      }
    }
  }

  void addDiagonal(int first, double weight) {
    for (int i = 0; i < kBlock; ++i) entries_.emplace_back(first + i, first + i, weight);
  }

  int vertices_;
  int held_;
  std::vector<double> weights_;
  std::vector<Eigen::Triplet<double>> entries_;
  Eigen::MatrixXd rhs_;
};

template <int kDim>
std::optional<std::vector<Eigen::Matrix<double, kDim, kDim>>> relaxedRotations(const BatchGraph<kDim>& graph) {
  using Matrix = Eigen::Matrix<double, kDim, kDim>;
  const int held = heldPose(graph);
  const Matrix held_rotation = rotationMatrix(graph.poses[held].T_world_vertex);
  // Unknown per pose: R^T. Row k of R_to = R_from R_ij is a column of R_to^T = R_ij^T R_from^T.
  RelaxedProblem<kDim> problem(graph.poseCount(), held, kDim);
  const Eigen::MatrixXd held_value = held_rotation.transpose();
  const Eigen::MatrixXd none = Eigen::MatrixXd::Zero(kDim, kDim);
  for (const auto& edge : graph.pose_edges) {
    const double weight =
        scalarWeight(edge.information.template bottomRightCorner < kDim == 2 ? 1 : 3, kDim == 2 ? 1 : 3 > ());
    problem.add(edge.from, edge.to, weight, rotationMatrix(edge.T_from_to), none, held_value);
  }
  const auto solution = problem.solve();
  if (!solution) return std::nullopt;
  std::vector<Matrix> rotations(graph.poses.size(), held_rotation);
  for (int i = 0; i < graph.poseCount(); ++i) {
    if (i == held) continue;
    const Matrix relaxed = solution->template middleRows<kDim>(problem.row(i));
    rotations[i] = nearestRotation<kDim>(relaxed.transpose());
  }
  return rotations;
}

}  // namespace

template <int kDim>
std::optional<std::vector<typename BatchGraph<kDim>::PoseType>> chordalGuess(const BatchGraph<kDim>& graph) {
  using PoseType = typename BatchGraph<kDim>::PoseType;
  const auto rotations = relaxedRotations(graph);
  if (!rotations) return std::nullopt;
  const int held = heldPose(graph);
  RelaxedProblem<1> problem(graph.poseCount(), held, kDim);
  const Eigen::MatrixXd held_value = graph.poses[held].T_world_vertex.translation_m.transpose();
  const Eigen::Matrix<double, 1, 1> one(1.0);
  for (const auto& edge : graph.pose_edges) {
    const double weight = scalarWeight(edge.information.template topLeftCorner<kDim, kDim>());
    const Eigen::MatrixXd step = ((*rotations)[edge.from] * edge.T_from_to.translation_m).transpose();
    problem.add(edge.from, edge.to, weight, one, step, held_value);
  }
  const auto translations = problem.solve();
  if (!translations) return std::nullopt;
  std::vector<PoseType> poses;
  poses.reserve(graph.poses.size());
  for (int i = 0; i < graph.poseCount(); ++i) {
    if (i == held) {
      poses.push_back(graph.poses[held].T_world_vertex);
    } else {
      poses.push_back(makePose((*rotations)[i], translations->row(problem.row(i)).transpose()));
    }
  }
  return poses;
}

template std::optional<std::vector<Pose2>> chordalGuess<2>(const BatchGraph<2>&);
template std::optional<std::vector<Pose>> chordalGuess<3>(const BatchGraph<3>&);

}  // namespace semantic_mht_slam
