#pragma once

#include <cmath>
#include <iterator>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

// What a value has to be to be one that the program wrote: the rules for reading a state.
namespace semantic_mht_slam {

constexpr double kRounding = 1e-6;  // of sums that were one when they were written

inline bool isProbability(double value) {
  return value >= 0.0 && value <= 1.0 + kRounding;
}

/// Probabilities of things of which one is true.
template <class Probs>
bool areProbabilities(const Probs& probs) {
  return probs.size() > 0 && (probs >= 0.0).all() && std::abs(probs.sum() - 1.0) < kRounding;
}

template <class Matrix>
bool isSymmetric(const Matrix& matrix) {
  if (matrix.rows() != matrix.cols() || !matrix.allFinite()) return false;
  if (matrix.size() == 0) return true;
  return (matrix - matrix.transpose()).cwiseAbs().maxCoeff() <= kRounding * matrix.cwiseAbs().maxCoeff();
}

/// A covariance, or an information matrix, that has an inverse.
template <class Matrix>
bool isPositive(const Matrix& matrix) {
  return isSymmetric(matrix) && matrix.llt().info() == Eigen::Success;
}

/// The same without one, up to rounding.
template <class Matrix>
bool isNotNegative(const Matrix& matrix) {
  if (!isSymmetric(matrix)) return false;
  if (matrix.size() == 0) return true;
  const Eigen::SelfAdjointEigenSolver<Matrix> solver(matrix, Eigen::EigenvaluesOnly);
  return solver.info() == Eigen::Success &&
         solver.eigenvalues().minCoeff() >= -kRounding * matrix.cwiseAbs().maxCoeff();
}

/// The upper square root of an information matrix.
template <class Matrix>
bool isSquareRoot(const Matrix& matrix) {
  return matrix.allFinite() && matrix.isUpperTriangular(0.0) && (matrix.diagonal().array() > 0.0).all();
}

/// Numbers that rise from each to the next; `key` gives them.
template <class List, class Key>
bool areRising(const List& list, const Key& key) {
  for (auto next = list.begin(); next != list.end(); ++next) {
    if (next != list.begin() && !(key(*std::prev(next)) < key(*next))) return false;
  }
  return true;
}

}  // namespace semantic_mht_slam
