#include "block_cholesky.h"

#include <Eigen/Cholesky>
#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <algorithm>

namespace arfm_vo {
namespace {

/// The position of each row in the order of elimination.
std::vector<int> Order(const BlockPattern& blocks) {
  const int num_rows = blocks.num_rows();
  if (num_rows == 0) return {};
  std::vector<Eigen::Triplet<double>> triplets;
  for (int row = 0; row < num_rows; ++row) {
    for (int i = blocks.row_begin[row]; i < blocks.row_begin[row + 1]; ++i) {
      triplets.emplace_back(row, blocks.columns[i], 1);
    }
  }
  Eigen::SparseMatrix<double> pattern(num_rows, num_rows);
  pattern.setFromTriplets(triplets.begin(), triplets.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> row_at;
  Eigen::AMDOrdering<int>()(pattern.selfadjointView<Eigen::Upper>(), row_at);
  std::vector<int> position(num_rows);
  for (int i = 0; i < num_rows; ++i) position[row_at.indices()[i]] = i;
  return position;
}

}  // namespace

BlockPattern::BlockPattern(std::vector<std::vector<int>> tied_to) {
  for (int row = 0; row < static_cast<int>(tied_to.size()); ++row) {
    std::vector<int>& ties = tied_to[row];
    ties.push_back(row);
    std::sort(ties.begin(), ties.end());
    columns.insert(columns.end(), ties.begin(), std::unique(ties.begin(), ties.end()));
    row_begin.push_back(static_cast<int>(columns.size()));
  }
}

int BlockPattern::Find(int row, int column, int from) const {
  // Neighbours on a path stand next to each other: a step or two, then a search.
  if (columns[from] == column) return from;
  const auto begin = columns.begin() + from + 1, end = columns.begin() + row_begin[row + 1];
  if (*begin == column) return from + 1;
  return static_cast<int>(std::lower_bound(begin, end, column) - columns.begin());
}

BlockCholesky::BlockCholesky(const BlockPattern& pattern) : position_(Order(pattern)) {
  std::vector<std::vector<int>> rows_of(position_.size());
  const auto for_each_block = [&](const auto& work) {
    for (size_t row = 0; row < position_.size(); ++row) {
      for (int i = pattern.row_begin[row]; i < pattern.row_begin[row + 1]; ++i) {
        work(position_[row], position_[pattern.columns[i]]);
      }
    }
  };
  for_each_block([&](int a, int b) { rows_of[std::min(a, b)].push_back(std::max(a, b)); });
  FindFillIn(std::move(rows_of));
  for_each_block([&](int a, int b) {
    targets_.push_back({Find(std::max(a, b), std::min(a, b)), a <= b});
  });
}

/// Eliminating a row joins all that it is joined to: each column hands its rows on to the column of
/// the first of them.
void BlockCholesky::FindFillIn(std::vector<std::vector<int>> rows_of) {
  begin_ = {0};
  for (size_t column = 0; column < rows_of.size(); ++column) {
    std::vector<int>& rows = rows_of[column];
    std::sort(rows.begin(), rows.end());
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
    if (rows.size() > 1) {
      std::vector<int>& next = rows_of[rows[1]];
      next.insert(next.end(), rows.begin() + 1, rows.end());
    }
    rows_.insert(rows_.end(), rows.begin(), rows.end());
    begin_.push_back(static_cast<int>(rows_.size()));
    rows = {};
  }
  factors_.resize(rows_.size());
}

int BlockCholesky::Find(int row, int column) const {
  const auto last = rows_.begin() + begin_[column + 1];
  return static_cast<int>(std::lower_bound(rows_.begin() + begin_[column], last, row) -
                          rows_.begin());
}

bool BlockCholesky::Factorize(const std::vector<Matrix6d>& blocks) {
  std::fill(factors_.begin(), factors_.end(), Matrix6d::Zero());
  for (size_t i = 0; i < blocks.size(); ++i) {
    Matrix6d& factor = factors_[targets_[i].block];
    if (targets_[i].is_transposed) {
      factor = blocks[i].transpose();
    } else {
      factor = blocks[i];
    }
  }
  for (int column = 0; column < num_rows(); ++column) {
    Matrix6d& diagonal = factors_[begin_[column]];
    const Eigen::LLT<Matrix6d> llt(diagonal);
    if (llt.info() != Eigen::Success) return false;
    diagonal = llt.matrixL();
    const Matrix6d inverse =
        diagonal.triangularView<Eigen::Lower>().solve(Matrix6d::Identity()).transpose();
    for (int i = begin_[column] + 1; i < begin_[column + 1]; ++i) {
      factors_[i] = Matrix6d(factors_[i].lazyProduct(inverse));
    }
    Subtract(column);
  }
  return true;
}

/// A finished column from those that its rows stand for.
void BlockCholesky::Subtract(int column) {
  const int last = begin_[column + 1];
  for (int k = begin_[column] + 1; k < last; ++k) {
    const Matrix6d turned = factors_[k].transpose();
    int target = begin_[rows_[k]];
    for (int i = k; i < last; ++i) {
      while (rows_[target] != rows_[i]) ++target;
      factors_[target].noalias() -= factors_[i].lazyProduct(turned);
    }
  }
}

Eigen::MatrixXd BlockCholesky::Solve(const Eigen::MatrixXd& right) const {
  Eigen::MatrixXd ordered(right.rows(), right.cols());
  const auto part = [&](int row) { return ordered.middleRows<6>(6 * row); };
  for (int row = 0; row < num_rows(); ++row) part(position_[row]) = right.middleRows<6>(6 * row);
  for (int column = 0; column < num_rows(); ++column) {
    factors_[begin_[column]].triangularView<Eigen::Lower>().solveInPlace(part(column));
    for (int i = begin_[column] + 1; i < begin_[column + 1]; ++i) {
      part(rows_[i]).noalias() -= factors_[i] * part(column);
    }
  }
  for (int column = num_rows() - 1; column >= 0; --column) {
    for (int i = begin_[column] + 1; i < begin_[column + 1]; ++i) {
      part(column).noalias() -= factors_[i].transpose() * part(rows_[i]);
    }
    factors_[begin_[column]].triangularView<Eigen::Lower>().transpose().solveInPlace(part(column));
  }
  Eigen::MatrixXd solution(right.rows(), right.cols());
  for (int row = 0; row < num_rows(); ++row) solution.middleRows<6>(6 * row) = part(position_[row]);
  return solution;
}

}  // namespace arfm_vo
