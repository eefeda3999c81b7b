#pragma once

#include <Eigen/Cholesky>
#include <array>
#include <vector>

#include "arfm_vo/bundle_adjustment/bundle_reprojection.h"
#include "block_cholesky.h"

namespace arfm_vo {

constexpr int kMaxCoefficients = StereoCorrection::kSize;
/// Of a pose by the coefficients of the correction that are free.
using BorderMatrix = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, kMaxCoefficients>;
using CornerMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor,
                                   kMaxCoefficients, kMaxCoefficients>;
using CornerVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMaxCoefficients, 1>;

/// Normal equations H d = b over the free poses and the stereo correction: the part of the whole
/// that is left when points are held or eliminated.
struct ReducedSystem {
  std::vector<Matrix6d> blocks;      ///< of poses by poses, as BlockPattern::columns
  std::vector<Vector6d> right;       ///< [free poses] of b
  std::vector<BorderMatrix> border;  ///< [free poses] of poses by correction
  CornerMatrix corner;               ///< of correction by correction, the lower triangle
  CornerVector corner_right;         ///< of b

  void SetZero(const BlockPattern& pattern, int num_coefficients);
  /// Adds what a constraint between the poses of two rows says; a row below 0: its pose is fixed.
  void Add(const ConstraintTerm& term, const Matrix6d& information, const std::array<int, 2>& rows,
           const BlockPattern& pattern);
};

/// Factorises reduced systems of one pattern, the correction after the poses.
class ReducedSolver {
 public:
  ReducedSolver(const BlockPattern& pattern, int num_coefficients);

  /// Returns false where the matrix is not positive definite.
  bool Factorize(const ReducedSystem& system);
  /// Six unknowns a free pose in their order, then those of the correction.
  Eigen::MatrixXd Solve(const Eigen::MatrixXd& right) const;
  Eigen::VectorXd SolveFor(const ReducedSystem& system) const;
  int size() const { return 6 * pattern_.num_rows() + num_coefficients_; }

 private:
  const BlockPattern& pattern_;
  const int num_coefficients_;
  BlockCholesky poses_factor_;
  Eigen::MatrixXd border_;           ///< [6 free poses x coefficients]
  Eigen::MatrixXd poses_by_border_;  ///< solved for it
  Eigen::LLT<Eigen::MatrixXd> corner_factor_;
};

}  // namespace arfm_vo
