#include "reduced_system.h"

namespace arfm_vo {
void ReducedSystem::SetZero(const BlockPattern& pattern, int num_coefficients) {
  blocks.assign(pattern.columns.size(), Matrix6d::Zero());
  right.assign(pattern.num_rows(), Vector6d::Zero());
  border.assign(pattern.num_rows(), BorderMatrix::Zero(6, num_coefficients));
  corner.setZero(num_coefficients, num_coefficients);
  corner_right.setZero(num_coefficients);
}

void ReducedSystem::Add(const ConstraintTerm& term, const Matrix6d& information,
                        const std::array<int, 2>& rows, const BlockPattern& pattern) {
  const Matrix6d* const jacobians[2] = {&term.by_first, &term.by_second};
  for (const int i : {0, 1}) {
    if (rows[i] < 0) continue;
    right[rows[i]] -= jacobians[i]->transpose() * information * term.residual;
    for (const int j : {0, 1}) {
      if (rows[j] < rows[i]) continue;  // the upper triangle; also a fixed pose
      blocks[pattern.Find(rows[i], rows[j])] +=
          jacobians[i]->transpose() * information * *jacobians[j];
    }
  }
}

ReducedSolver::ReducedSolver(const BlockPattern& pattern, int num_coefficients)
    : pattern_(pattern),
      num_coefficients_(num_coefficients),
      poses_factor_(pattern),
      border_(6 * pattern.num_rows(), num_coefficients) {}

bool ReducedSolver::Factorize(const ReducedSystem& system) {
  if (!poses_factor_.Factorize(system.blocks)) return false;
  if (num_coefficients_ == 0) return true;
  for (int i = 0; i < pattern_.num_rows(); ++i) {
    border_.middleRows<6>(6 * i) = system.border[i];
  }
  poses_by_border_ = poses_factor_.Solve(border_);
  corner_factor_.compute(system.corner - border_.transpose() * poses_by_border_);
  return corner_factor_.info() == Eigen::Success;
}

Eigen::MatrixXd ReducedSolver::Solve(const Eigen::MatrixXd& right) const {
  Eigen::MatrixXd solution(right.rows(), right.cols());
  auto poses = solution.topRows(size() - num_coefficients_);
  auto correction = solution.bottomRows(num_coefficients_);
  poses = poses_factor_.Solve(right.topRows(poses.rows()));
  if (num_coefficients_ == 0) return solution;
  correction =
      corner_factor_.solve(right.bottomRows(num_coefficients_) - border_.transpose() * poses);
  poses -= poses_by_border_ * correction;
  return solution;
}

Eigen::VectorXd ReducedSolver::SolveFor(const ReducedSystem& system) const {
  Eigen::VectorXd right(size());
  for (int i = 0; i < pattern_.num_rows(); ++i) right.segment<6>(6 * i) = system.right[i];
  right.tail(num_coefficients_) = system.corner_right;
  return Solve(right);
}

}  // namespace arfm_vo
