#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include <Eigen/Core>

#include "semantic_mht_slam/common/dense_solvers.h"
#include "semantic_mht_slam/common/text.h"
#include "semantic_mht_slam/io/g2o_file.h"

#include "g2o_line.h"

namespace semantic_mht_slam {

constexpr double kRelativePivot = 1e-13;       // below that, a Cholesky pivot is rounding noise of a singular matrix
constexpr double kProjectedEigenvalue = 1e-9;  // of the largest one

inline void readPose(G2oLine& line, Pose2& pose) {
  pose.translation_m.x() = line.number();
  pose.translation_m.y() = line.number();
  pose.heading_rad = line.number();
}

inline void readPose(G2oLine& line, Pose& pose) {
  for (int i = 0; i < 3; ++i) pose.translation_m[i] = line.number();
  for (int i = 0; i < 4; ++i) pose.rotation.coeffs()[i] = line.number();
  const double norm = pose.rotation.norm();
  if (std::abs(norm - 1.0) > 0.1) line.fail("quaternion has norm " + formatDouble(norm));
  pose = normalized(pose);
}

template <int kSize>
Eigen::Matrix<double, kSize, kSize> readUpperTriangle(G2oLine& line) {
  Eigen::Matrix<double, kSize, kSize> matrix;
  for (int row = 0; row < kSize; ++row) {
    for (int col = row; col < kSize; ++col) matrix(row, col) = matrix(col, row) = line.number();
  }
  return matrix;
}

inline bool isPositiveDefinite(const Eigen::MatrixXd& matrix) {
  const auto factor = choleskyOf(matrix);
  if (!factor) return false;
  for (int i = 0; i < matrix.rows(); ++i) {
    const double pivot = factor->matrixLLT()(i, i);
    if (!(pivot * pivot > kRelativePivot * matrix(i, i))) return false;
  }
  return true;
}

/// Reads, checks and where asked repairs the information matrix at the end of an edge.
template <int kSize>
Eigen::Matrix<double, kSize, kSize> readInformation(G2oLine& line, BadInformation policy, G2oFile& file) {
  using Matrix = Eigen::Matrix<double, kSize, kSize>;
  const Matrix matrix = readUpperTriangle<kSize>(line);
  line.finish();
  if (isPositiveDefinite(matrix)) return matrix;
  const SymmetricEigen eigen = symmetricEigen(matrix);
  const double largest = eigen.values.maxCoeff();
  if (policy == BadInformation::kRefuse || !(largest > 0.0)) {
    line.fail("the information matrix is not positive definite (smallest eigenvalue " +
              formatDouble(eigen.values.minCoeff()) + ")");
  }
  file.projected_edges.push_back(line.name());
  const Eigen::Matrix<double, kSize, 1> raised = eigen.values.cwiseMax(kProjectedEigenvalue * largest);
  const Matrix vectors = eigen.vectors;
  const Matrix repaired = vectors * raised.asDiagonal() * vectors.transpose();
  return 0.5 * (repaired + repaired.transpose());
}

/// Index of each vertex id, in order of appearance until `sortById`.
template <class Vertex>
class VertexTable {
 public:
  explicit VertexTable(std::vector<Vertex>& vertices) : vertices_(vertices) {}

  int indexOf(std::int64_t id) {
    const auto [entry, is_new] = index_.try_emplace(id, static_cast<int>(vertices_.size()));
    if (is_new) {
      vertices_.emplace_back();
      vertices_.back().id = id;
    }
    return entry->second;
  }

  Vertex& define(std::int64_t id, const G2oLine& line) {
    Vertex& vertex = vertices_[indexOf(id)];
    if (vertex.has_estimate) line.fail("the vertex is defined twice");
    vertex.has_estimate = true;
    return vertex;
  }

  bool contains(std::int64_t id) const { return index_.count(id) > 0; }

  /// Sorts the vertices; returns the new index of every old one.
  std::vector<int> sortById() {
    std::vector<int> order(vertices_.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
    std::sort(order.begin(), order.end(), [this](int a, int b) { return vertices_[a].id < vertices_[b].id; });
    std::vector<Vertex> sorted;
    sorted.reserve(vertices_.size());
    std::vector<int> new_index(order.size());
    for (const int old : order) {
      new_index[old] = static_cast<int>(sorted.size());
      sorted.push_back(vertices_[old]);
    }
    vertices_.swap(sorted);
    return new_index;
  }

 private:
  std::vector<Vertex>& vertices_;
  std::unordered_map<std::int64_t, int> index_;
};

template <int kDim>
struct Tags;
template <>
struct Tags<2> {
  static constexpr const char* kPose = "VERTEX_SE2";
  static constexpr const char* kPoint = "VERTEX_XY";
  static constexpr const char* kPoseEdge = "EDGE_SE2";
  static constexpr const char* kPointEdge = "EDGE_SE2_XY";
};
template <>
struct Tags<3> {
  static constexpr const char* kPose = "VERTEX_SE3:QUAT";
  static constexpr const char* kPoint = "VERTEX_TRACKXYZ";
  static constexpr const char* kPoseEdge = "EDGE_SE3:QUAT";
  static constexpr const char* kPointEdge = "EDGE_SE3_TRACKXYZ";
};

}  // namespace semantic_mht_slam
