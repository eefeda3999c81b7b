#include "reduced_system.h"

namespace arfm_vo {
namespace {

constexpr int kMaxDensePoses = 30;

template <class Operation>
void ForEachPart(ReducedSystem& a, const ReducedSystem& b, Operation&& operation) {
  for (size_t i = 0; i < a.blocks.size(); ++i) operation(a.blocks[i], b.blocks[i]);
  for (size_t i = 0; i < a.right.size(); ++i) operation(a.right[i], b.right[i]);
  for (size_t i = 0; i < a.border.size(); ++i) operation(a.border[i], b.border[i]);
  operation(a.corner, b.corner);
  operation(a.corner_right, b.corner_right);
}

}  // namespace

void ReducedSystem::SetZero(const BundleStructure& structure, int num_coefficients) {
  blocks.assign(structure.columns.size(), Matrix6d::Zero());
  right.assign(structure.num_free_poses(), Vector6d::Zero());
  border.assign(structure.num_free_poses(), BorderMatrix<6>::Zero(6, num_coefficients));
  corner.setZero(num_coefficients, num_coefficients);
  corner_right.setZero(num_coefficients);
}

ReducedSystem& ReducedSystem::operator+=(const ReducedSystem& other) {
  ForEachPart(*this, other, [](auto& a, const auto& b) { a += b; });
  return *this;
}

ReducedSystem& ReducedSystem::operator-=(const ReducedSystem& other) {
  ForEachPart(*this, other, [](auto& a, const auto& b) { a -= b; });
  return *this;
}

ReducedSolver::ReducedSolver(const BundleStructure& structure, int num_coefficients)
    : structure_(structure),
      num_coefficients_(num_coefficients),
      is_dense_(structure.num_free_poses() <= kMaxDensePoses) {
  if (is_dense_) {
    dense_.setZero(size(), size());
    return;
  }
  // The pattern of the upper triangle, column by column.
  std::vector<std::vector<int>> rows_of(structure.num_free_poses());
  for (int row = 0; row < structure.num_free_poses(); ++row) {
    for (int i = structure.row_begin[row]; i < structure.row_begin[row + 1]; ++i) {
      rows_of[structure.columns[i]].push_back(row);
    }
  }
  sparse_.resize(size(), size());
  std::vector<Eigen::Triplet<double>> triplets;
  for (int column = 0; column < size(); ++column) {
    if (column < size() - num_coefficients) {
      for (const int row : rows_of[column / 6]) {
        for (int i = 6 * row; i < 6 * row + 6 && i <= column; ++i)
          triplets.emplace_back(i, column, 1);
      }
    } else {
      for (int row = 0; row <= column; ++row) triplets.emplace_back(row, column, 1);
    }
  }
  sparse_.setFromTriplets(triplets.begin(), triplets.end());
  sparse_factor_.analyzePattern(sparse_);
}

bool ReducedSolver::Factorize(const ReducedSystem& system) {
  return is_dense_ ? FactorizeDense(system) : FactorizeSparse(system);
}

bool ReducedSolver::FactorizeDense(const ReducedSystem& system) {
  const int num_poses = structure_.num_free_poses();
  for (int row = 0; row < num_poses; ++row) {
    for (int i = structure_.row_begin[row]; i < structure_.row_begin[row + 1]; ++i) {
      dense_.block<6, 6>(6 * row, 6 * structure_.columns[i]) = system.blocks[i];
    }
    dense_.block(6 * row, 6 * num_poses, 6, num_coefficients_) = system.border[row];
  }
  dense_.bottomRightCorner(num_coefficients_, num_coefficients_) = system.corner;
  dense_factor_.compute(dense_.selfadjointView<Eigen::Upper>());
  return dense_factor_.info() == Eigen::Success;
}

bool ReducedSolver::FactorizeSparse(const ReducedSystem& system) {
  const int num_poses = structure_.num_free_poses();
  // The rows of a block stand together in each column of the pattern; blocks of a column come in
  // the order of their rows, which is the order of this walk.
  std::vector<int> next(size());
  for (int column = 0; column < size(); ++column) next[column] = sparse_.outerIndexPtr()[column];
  for (int row = 0; row < num_poses; ++row) {
    for (int i = structure_.row_begin[row]; i < structure_.row_begin[row + 1]; ++i) {
      const bool is_diagonal = structure_.columns[i] == row;
      for (int k = 0; k < 6; ++k) {
        const int column = 6 * structure_.columns[i] + k;
        const int count = is_diagonal ? k + 1 : 6;
        for (int r = 0; r < count; ++r) sparse_.valuePtr()[next[column]++] = system.blocks[i](r, k);
      }
    }
    for (int k = 0; k < num_coefficients_; ++k) {
      for (int r = 0; r < 6; ++r) {
        sparse_.valuePtr()[next[6 * num_poses + k]++] = system.border[row](r, k);
      }
    }
  }
  for (int k = 0; k < num_coefficients_; ++k) {
    for (int r = 0; r <= k; ++r) {
      sparse_.valuePtr()[next[6 * num_poses + k]++] = system.corner(r, k);
    }
  }
  sparse_factor_.factorize(sparse_);
  return sparse_factor_.info() == Eigen::Success;
}

Eigen::MatrixXd ReducedSolver::Solve(const Eigen::MatrixXd& right) const {
  if (is_dense_) return dense_factor_.solve(right);
  return sparse_factor_.solve(right);
}

Eigen::VectorXd ReducedSolver::SolveFor(const ReducedSystem& system) const {
  Eigen::VectorXd right(size());
  for (int i = 0; i < structure_.num_free_poses(); ++i) right.segment<6>(6 * i) = system.right[i];
  right.tail(num_coefficients_) = system.corner_right;
  return Solve(right);
}

}  // namespace arfm_vo
