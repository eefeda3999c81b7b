#pragma once

#include <Eigen/Core>
#include <optional>

namespace arfm_vo {

// Eigen's decompositions for symmetric matrices of any size, compiled once: as templates each size
// takes a compiler seconds. For code that runs some times a pair; what runs for each point keeps
// Eigen's own fixed sizes.

using MatrixRef = Eigen::Ref<const Eigen::MatrixXd>;
using VectorRef = Eigen::Ref<const Eigen::VectorXd>;

/// x^T C^-1 x for a covariance C [N x N], positive definite.
double SquaredMahalanobis(const VectorRef& x, const MatrixRef& covariance);

/// The covariance J C J^T [M x M] of J x, for J [M x N] and the covariance C [N x N] of x.
Eigen::MatrixXd Propagate(const MatrixRef& jacobian, const MatrixRef& covariance);

/// Whether SolveDefinite solves with it.
bool IsPositiveDefinite(const MatrixRef& symmetric);

/// X [N x K] with A X = B, for A [N x N] symmetric, semidefinite too (LDL^T with pivots).
Eigen::MatrixXd SolveSymmetric(const MatrixRef& a, const MatrixRef& b);

/// The same, but nothing where A is not positive definite, its condition above 1e12, or NaN in it.
std::optional<Eigen::MatrixXd> SolveDefinite(const MatrixRef& a, const MatrixRef& b);

/// Of a symmetric matrix, positive definite.
Eigen::MatrixXd InvertDefinite(const MatrixRef& matrix);

/// R [N x N] with R^T R = A, for A symmetric, semidefinite too.
Eigen::MatrixXd SquareRoot(const MatrixRef& a);

/// Eigenvalues, ascending, and eigenvectors as columns in the same order.
struct SymmetricEigen {
  explicit SymmetricEigen(const MatrixRef& symmetric);
  /// Generalised: A x = value B x for A symmetric and B positive definite; vectors^T B vectors = 1.
  SymmetricEigen(const MatrixRef& a, const MatrixRef& b);

  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};

/// The rotation R, a proper one and the smallest of those that fit alike, that makes the sum of
/// (R a_i) . b_i largest, for the correlation of the points: the sum of b_i a_i^T (Horn, Closed-form solution of absolute orientation using
/// unit quaternions, JOSA A 1987).
Eigen::Matrix3d FindRotation(const Eigen::Matrix3d& correlation);

}  // namespace arfm_vo
