#include "block_cholesky.h"

#include <algorithm>
#include <iterator>

#include <Eigen/Cholesky>
#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>

namespace semantic_mht_slam {
namespace {

/// Which blocks each block is in a clique with, itself left out, rising.
std::vector<std::vector<int>> neighboursOf(int size, const std::vector<std::vector<int>>& cliques) {
  std::vector<std::vector<int>> neighbours(size);
  const auto tidy = [](std::vector<int>& list) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  };
  std::vector<std::size_t> tidied(neighbours.size(), 64);
  for (const std::vector<int>& clique : cliques) {
    for (const int a : clique) {
      std::vector<int>& list = neighbours[a];
      for (const int b : clique) {
        if (a != b) list.push_back(b);
      }
      std::size_t& limit = tidied[a];
      if (list.size() < limit) continue;
      tidy(list);
      limit = 2 * std::max(list.size(), limit / 2);
    }
  }
  for (std::vector<int>& list : neighbours) tidy(list);
  return neighbours;
}

/// Place of each block in an order of elimination that keeps the factor sparse.
std::vector<int> eliminationOrder(const std::vector<std::vector<int>>& neighbours) {
  const auto size = static_cast<int>(neighbours.size());
  if (size == 0) return {};
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < size; ++i) {
    entries.emplace_back(i, i, 1.0);
    for (const int other : neighbours[i]) entries.emplace_back(i, other, 1.0);
  }
  Eigen::SparseMatrix<double> pattern(size, size);
  pattern.setFromTriplets(entries.begin(), entries.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
  Eigen::AMDOrdering<int>()(pattern, order);
  std::vector<int> position(neighbours.size());
  for (int place = 0; place < size; ++place) position[order.indices()[place]] = place;
  return position;
}

}  // namespace

std::size_t BlockCholesky::Column::find(int row) const {
  return std::lower_bound(rows.begin(), rows.end(), row) - rows.begin();
}

BlockCholesky::BlockCholesky(int size, const std::vector<std::vector<int>>& cliques) : columns_(size) {
  const std::vector<std::vector<int>> neighbours = neighboursOf(size, cliques);
  position_ = eliminationOrder(neighbours);
  for (std::size_t i = 0; i < neighbours.size(); ++i) {
    std::vector<int>& rows = columns_[position_[i]].rows;
    for (const int other : neighbours[i]) {
      const int row = position_[other];
      if (row > position_[i]) rows.push_back(row);
    }
    std::sort(rows.begin(), rows.end());
  }
  // Eliminating a block joins all that it is joined with; the first of these passes it on.
  for (Column& column : columns_) {
    column.blocks.assign(column.rows.size(), Matrix6d::Zero());
    if (column.rows.empty()) continue;
    std::vector<int>& rows = columns_[column.rows.front()].rows;
    std::vector<int> joined;
    std::set_union(rows.begin(), rows.end(), column.rows.begin() + 1, column.rows.end(), std::back_inserter(joined));
    rows = std::move(joined);
  }
}

void BlockCholesky::add(int row, int column, const Matrix6d& block) {
  const int r = position_[row];
  const int c = position_[column];
  Column& place = columns_[std::min(r, c)];
  if (r == c) {
    place.diagonal += block;
  } else if (r > c) {
    place.blocks[place.find(r)] += block;
  } else {
    place.blocks[place.find(c)] += block.transpose();
  }
}

bool BlockCholesky::factorize() {
  for (Column& column : columns_) {
    const Eigen::LLT<Matrix6d> root(column.diagonal);
    if (root.info() != Eigen::Success) return false;
    column.diagonal = root.matrixL().solve(Matrix6d::Identity());
    if (!column.diagonal.allFinite()) return false;
    for (Matrix6d& block : column.blocks) block = (block * column.diagonal.transpose()).eval();
    for (std::size_t a = 0; a < column.rows.size(); ++a) {
      Column& later = columns_[column.rows[a]];
      const Matrix6d across = column.blocks[a].transpose();
      later.diagonal.noalias() -= column.blocks[a] * across;
      std::size_t place = 0;
      for (std::size_t b = a + 1; b < column.rows.size(); ++b) {
        while (later.rows[place] < column.rows[b]) ++place;
        later.blocks[place].noalias() -= column.blocks[b] * across;
      }
    }
  }
  return true;
}

Eigen::MatrixXd BlockCholesky::solve(const Eigen::MatrixXd& right) const {
  Eigen::MatrixXd x(right.rows(), right.cols());
  for (std::size_t i = 0; i < position_.size(); ++i) {
    x.middleRows<6>(6 * position_[i]) = right.middleRows<6>(6 * i);
  }
  for (std::size_t j = 0; j < columns_.size(); ++j) {
    const Column& column = columns_[j];
    auto own = x.middleRows<6>(6 * j);
    own = (column.diagonal * own).eval();
    for (std::size_t a = 0; a < column.rows.size(); ++a) {
      x.middleRows<6>(6 * column.rows[a]).noalias() -= column.blocks[a] * own;
    }
  }
  for (std::size_t j = columns_.size(); j-- > 0;) {
    const Column& column = columns_[j];
    auto own = x.middleRows<6>(6 * j);
    for (std::size_t a = 0; a < column.rows.size(); ++a) {
      own.noalias() -= column.blocks[a].transpose() * x.middleRows<6>(6 * column.rows[a]);
    }
    own = (column.diagonal.transpose() * own).eval();
  }
  Eigen::MatrixXd result(right.rows(), right.cols());
  for (std::size_t i = 0; i < position_.size(); ++i) {
    result.middleRows<6>(6 * i) = x.middleRows<6>(6 * position_[i]);
  }
  return result;
}

void BlockCholesky::invert() {
  std::vector<Matrix6d> steps;
  std::vector<Matrix6d> sums;
  for (std::size_t j = columns_.size(); j-- > 0;) {
    Column& column = columns_[j];
    const std::size_t count = column.rows.size();
    steps.resize(count);
    sums.assign(count, Matrix6d::Zero());
    for (std::size_t a = 0; a < count; ++a) steps[a].noalias() = column.blocks[a] * column.diagonal;
    for (std::size_t a = 0; a < count; ++a) {
      const Column& later = columns_[column.rows[a]];
      sums[a].noalias() += later.diagonal * steps[a];
      std::size_t place = 0;
      for (std::size_t b = a + 1; b < count; ++b) {
        while (later.rows[place] < column.rows[b]) ++place;
        sums[b].noalias() += later.blocks[place] * steps[a];
        sums[a].noalias() += later.blocks[place].transpose() * steps[b];
      }
    }
    column.diagonal = (column.diagonal.transpose() * column.diagonal).eval();
    for (std::size_t a = 0; a < count; ++a) {
      column.diagonal.noalias() += steps[a].transpose() * sums[a];
      column.blocks[a] = -sums[a];
    }
  }
}

Matrix6d BlockCholesky::inverse(int row, int column) const {
  const int r = position_[row];
  const int c = position_[column];
  const Column& place = columns_[std::min(r, c)];
  if (r == c) return place.diagonal;
  if (r > c) return place.blocks[place.find(r)];
  return place.blocks[place.find(c)].transpose();
}

}  // namespace semantic_mht_slam
