#pragma once

#include <cmath>
#include <iterator>

#include <Eigen/Core>

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

/// A covariance, or an information matrix, that has an inverse.
bool isPositive(const Eigen::MatrixXd& matrix);

/// The same without one, up to rounding.
bool isNotNegative(const Eigen::MatrixXd& matrix);

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
