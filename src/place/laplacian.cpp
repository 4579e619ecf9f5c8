#include "semantic_mht_slam/place/laplacian.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace semantic_mht_slam {
namespace {

using PairWeight = std::function<double(const SceneObject&, const SceneObject&)>;

void requireClasses(const Scene& scene, int classes) {
  for (const SceneObject& object : scene.objects) {
    if (object.class_index < 0 || object.class_index >= classes) {
      throw std::invalid_argument("class " + std::to_string(object.class_index) + " is not in the table");
    }
  }
}

double kernelOf(const SceneObject& a, const SceneObject& b, const CovisibilityConfig& config) {
  return distanceKernel((a.position_m - b.position_m).norm(), config);
}

Eigen::MatrixXd laplacianOf(const Scene& scene, int classes, const PairWeight& weight) {
  requireClasses(scene, classes);
  Eigen::MatrixXd laplacian = Eigen::MatrixXd::Zero(classes, classes);
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const SceneObject& a = scene.objects[i];
      const SceneObject& b = scene.objects[j];
      const double w = weight(a, b);
      laplacian(a.class_index, a.class_index) += w;
      laplacian(b.class_index, b.class_index) += w;
      laplacian(a.class_index, b.class_index) -= w;
      if (a.class_index != b.class_index) laplacian(b.class_index, a.class_index) -= w;
    }
  }
  return laplacian;
}

// The entries of the rows and columns that are not zero in both, less their mean.
struct CentredEntries {
  Eigen::VectorXd a;
  Eigen::VectorXd b;
};

CentredEntries centredEntries(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  std::vector<Eigen::Index> present;
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    if ((a.row(i).array() != 0.0).any() || (b.row(i).array() != 0.0).any()) present.push_back(i);
  }
  const auto size = static_cast<Eigen::Index>(present.size());
  CentredEntries entries{Eigen::VectorXd(size * size), Eigen::VectorXd(size * size)};
  Eigen::Index k = 0;
  for (const Eigen::Index row : present) {
    for (const Eigen::Index column : present) {
      entries.a[k] = a(row, column);
      entries.b[k++] = b(row, column);
    }
  }
  if (k == 0) return entries;
  entries.a.array() -= entries.a.mean();
  entries.b.array() -= entries.b.mean();
  return entries;
}

}  // namespace

Eigen::MatrixXd classLaplacian(const Scene& scene, int classes, const CovisibilityGraph& graph,
                               const CovisibilityConfig& config) {
  return laplacianOf(scene, classes, [&](const SceneObject& a, const SceneObject& b) {
    const double w = graph.weight(a.landmark, b.landmark);  // 0: never seen together
    return w > 0.0 ? w : kernelOf(a, b, config);
  });
}

Eigen::MatrixXd classLaplacian(const Scene& scene, int classes, const CovisibilityConfig& config) {
  return laplacianOf(scene, classes,
                     [&](const SceneObject& a, const SceneObject& b) { return kernelOf(a, b, config); });
}

double laplacianCorrelation(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  if (a.rows() != b.rows() || a.cols() != b.cols()) throw std::invalid_argument("Laplacians of different sizes");
  const CentredEntries entries = centredEntries(a, b);
  if (entries.a.size() == 0) return 0.0;
  // What is left of equal entries is rounding, in proportion to the entries themselves.
  const double norm_a = entries.a.norm();
  const double norm_b = entries.b.norm();
  if (norm_a <= 1e-12 * a.norm() || norm_b <= 1e-12 * b.norm()) return 0.0;
  return std::clamp(entries.a.dot(entries.b) / (norm_a * norm_b), -1.0, 1.0);
}

}  // namespace semantic_mht_slam
