#pragma once

#include <cstdint>

#include <Eigen/Core>

namespace semantic_mht_slam {

/// What of a square matrix tells all of it.
enum class MatrixForm : std::uint8_t { kFull, kZero, kDiagonal, kSymmetric, kUpper };

template <class Matrix>
MatrixForm formOf(const Matrix& matrix) {
  bool lower = false;
  bool upper = false;
  bool diagonal = false;
  bool symmetric = true;
  for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
    diagonal = diagonal || matrix(row, row) != 0.0;
    for (Eigen::Index col = row + 1; col < matrix.cols(); ++col) {
      upper = upper || matrix(row, col) != 0.0;
      lower = lower || matrix(col, row) != 0.0;
      symmetric = symmetric && matrix(row, col) == matrix(col, row);
    }
  }
  if (!lower && !upper) return diagonal ? MatrixForm::kDiagonal : MatrixForm::kZero;
  if (symmetric) return MatrixForm::kSymmetric;
  return lower ? MatrixForm::kFull : MatrixForm::kUpper;
}

}  // namespace semantic_mht_slam
