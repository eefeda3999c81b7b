#include "reduced_system.h"

namespace arfm_vo {
namespace {

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
      poses_factor_(structure.row_begin, structure.columns),
      border_(6 * structure.num_free_poses(), num_coefficients) {}

bool ReducedSolver::Factorize(const ReducedSystem& system) {
  if (!poses_factor_.Factorize(system.blocks)) return false;
  if (num_coefficients_ == 0) return true;
  for (int i = 0; i < structure_.num_free_poses(); ++i) {
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
  for (int i = 0; i < structure_.num_free_poses(); ++i) right.segment<6>(6 * i) = system.right[i];
  right.tail(num_coefficients_) = system.corner_right;
  return Solve(right);
}

}  // namespace arfm_vo
