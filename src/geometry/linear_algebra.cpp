#include "arfm_vo/geometry/linear_algebra.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

namespace arfm_vo {

using Eigen::MatrixXd;

double SquaredMahalanobis(const VectorRef& x, const MatrixRef& covariance) {
  return x.dot(SolveSymmetric(covariance, x).col(0));
}

MatrixXd Propagate(const MatrixRef& jacobian, const MatrixRef& covariance) {
  const MatrixXd half = jacobian * covariance;
  return half * jacobian.transpose();
}

MatrixXd SolveSymmetric(const MatrixRef& a, const MatrixRef& b) {
  return Eigen::LDLT<MatrixXd>(a).solve(b);
}

bool IsPositiveDefinite(const MatrixRef& symmetric) {
  return SolveDefinite(symmetric, symmetric.col(0)).has_value();
}

std::optional<MatrixXd> SolveDefinite(const MatrixRef& a, const MatrixRef& b) {
  constexpr double kMaxCondition = 1e12;
  const Eigen::LDLT<MatrixXd> factor(a);
  const bool is_definite =
      a.allFinite() && factor.vectorD().minCoeff() > 0 && factor.rcond() * kMaxCondition >= 1;
  return is_definite ? std::optional<MatrixXd>(factor.solve(b)) : std::nullopt;
}

MatrixXd InvertDefinite(const MatrixRef& matrix) {
  return SolveSymmetric(matrix, MatrixXd::Identity(matrix.rows(), matrix.cols()));
}

SymmetricEigen::SymmetricEigen(const MatrixRef& symmetric) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(symmetric);
  values = solver.eigenvalues();
  vectors = solver.eigenvectors();
}

SymmetricEigen::SymmetricEigen(const MatrixRef& a, const MatrixRef& b) {
  const SymmetricEigen of_b(b);
  const MatrixXd whitened = of_b.vectors * of_b.values.cwiseSqrt().cwiseInverse().asDiagonal();
  const SymmetricEigen of_a(Propagate(whitened.transpose(), a));
  values = of_a.values;
  vectors = whitened * of_a.vectors;
}

MatrixXd SquareRoot(const MatrixRef& a) {
  const SymmetricEigen of_a(a);
  return of_a.values.cwiseMax(0).cwiseSqrt().asDiagonal() * of_a.vectors.transpose();
}

Eigen::Matrix3d FindRotation(const Eigen::Matrix3d& correlation) {
  const Eigen::Matrix3d& m = correlation;
  Eigen::Matrix4d profile;  // of the quaternion (x, y, z, w)
  profile.topLeftCorner<3, 3>() = m + m.transpose() - m.trace() * Eigen::Matrix3d::Identity();
  profile.topRightCorner<3, 1>() << m(2, 1) - m(1, 2), m(0, 2) - m(2, 0), m(1, 0) - m(0, 1);
  profile.bottomLeftCorner<1, 3>() = profile.topRightCorner<3, 1>().transpose();
  profile(3, 3) = m.trace() + 1e-12 * m.norm();  // the smallest of rotations that fit alike
  const Eigen::Vector4d largest = SymmetricEigen(profile).vectors.col(3);
  return Eigen::Quaterniond(largest).toRotationMatrix();
}

}  // namespace arfm_vo
