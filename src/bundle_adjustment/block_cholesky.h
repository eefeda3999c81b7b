#pragma once

#include <Eigen/Core>
#include <vector>

namespace arfm_vo {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// The blocks of the upper triangle of a symmetric matrix that may not be zero, row by row:
/// (row, columns[i]) for i in [row_begin[row], row_begin[row + 1]), ascending, the diagonal first.
struct BlockPattern {
  std::vector<int> row_begin = {0}, columns;

  BlockPattern() = default;
  /// `tied_to`: for each row the later rows that it is tied to, in any order, also repeatedly.
  explicit BlockPattern(std::vector<std::vector<int>> tied_to);
  int num_rows() const { return static_cast<int>(row_begin.size()) - 1; }
  /// The index of block (row, column) into `columns`; it must be there. `from` must not lie behind
  /// it in its row.
  int Find(int row, int column, int from) const;
  int Find(int row, int column) const { return Find(row, column, row_begin[row]); }
};

/// Cholesky factors of symmetric matrices of 6 x 6 blocks, most of them zero, that share one
/// pattern. Rows are taken in an order that leaves few blocks to fill in (approximate minimum
/// degree).
class BlockCholesky {
 public:
  explicit BlockCholesky(const BlockPattern& pattern);

  /// `blocks`: [columns of the pattern], of those on the diagonal the upper triangle. Returns false
  /// where the matrix is not positive definite.
  bool Factorize(const std::vector<Matrix6d>& blocks);
  /// [6 rows x N], after Factorize.
  Eigen::MatrixXd Solve(const Eigen::MatrixXd& right) const;

 private:
  struct Target {
    int block;           ///< of factors_
    bool is_transposed;  ///< the order turned the block into the lower triangle
  };
  int num_rows() const { return static_cast<int>(begin_.size()) - 1; }
  int Find(int row, int column) const;
  void FindFillIn(std::vector<std::vector<int>> rows_of);
  void Subtract(int column);

  std::vector<int> position_;      ///< [rows] of a row in the order of elimination
  std::vector<int> begin_, rows_;  ///< of the factor's columns; the diagonal first
  std::vector<Matrix6d> factors_;  ///< [rows_], lower triangle
  std::vector<Target> targets_;    ///< [blocks]
};

}  // namespace arfm_vo
