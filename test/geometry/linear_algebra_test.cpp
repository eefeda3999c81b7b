#include "arfm_vo/geometry/linear_algebra.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "arfm_vo/geometry/rigid3.h"

namespace arfm_vo {
namespace {

using Eigen::MatrixXd;

/// Two functions for all sizes, as products and comparisons take the compiler long.
MatrixXd Times(const MatrixXd& a, const MatrixXd& b) { return a * b; }

double Distance(const MatrixXd& a, const MatrixXd& b) { return (a - b).lpNorm<Eigen::Infinity>(); }

MatrixXd One(int size) { return MatrixXd::Identity(size, size); }

MatrixXd Diagonal(const Eigen::VectorXd& values) { return values.asDiagonal(); }

/// Symmetric, with eigenvalues from 1 to `size`.
MatrixXd Definite(int size) {
  MatrixXd basis(size, size);
  for (int i = 0; i < size; ++i)
    for (int k = 0; k < size; ++k)
      basis(i, k) = std::sqrt((k == 0 ? 1. : 2.) / size) * std::cos(M_PI * (i + 0.5) * k / size);
  return Propagate(basis, Diagonal(Eigen::VectorXd::LinSpaced(size, 1, size)));
}

TEST(LinearAlgebra, SolvesAndInvertsWhatIsDefinite) {
  for (const int size : {1, 3, 6, 17}) {
    const MatrixXd matrix = Definite(size), right = MatrixXd::Random(size, 2);
    EXPECT_LT(Distance(Times(matrix, SolveSymmetric(matrix, right)), right), 1e-12) << size;
    EXPECT_LT(Distance(Times(matrix, *SolveDefinite(matrix, right)), right), 1e-12) << size;
    EXPECT_LT(Distance(Times(matrix, InvertDefinite(matrix)), One(size)), 1e-12) << size;
    EXPECT_TRUE(IsPositiveDefinite(matrix)) << size;
    EXPECT_FALSE(IsPositiveDefinite(matrix - 1.5 * One(size))) << size;
  }
}

TEST(LinearAlgebra, NothingIsSolvedByAMatrixThatIsNotDefinite) {
  const Eigen::Vector3d right(1, 2, 3);
  for (const double last : {0.0, -1.0, 1e-13, std::nan("")}) {
    EXPECT_FALSE(SolveDefinite(Diagonal(Eigen::Vector3d(1, 2, last)), right)) << last;
  }
  EXPECT_FALSE(IsPositiveDefinite(MatrixXd::Constant(3, 3, std::nan(""))));
}

TEST(LinearAlgebra, CovariancesOfStepsAndTheirDistances) {
  const MatrixXd covariance = Diagonal(Eigen::Vector2d(4, 9));
  EXPECT_DOUBLE_EQ(SquaredMahalanobis(Eigen::Vector2d(2, 6), covariance), 1 + 4);
  const MatrixXd jacobian = MatrixXd::Random(3, 2), back = jacobian.transpose();
  EXPECT_LT(Distance(Propagate(jacobian, covariance), Times(Times(jacobian, covariance), back)),
            1e-12);
}

TEST(LinearAlgebra, EigenvectorsOfOneAndOfTwoMatrices) {
  const MatrixXd a = Definite(6), b = Definite(6) + MatrixXd::Constant(6, 6, 0.1);
  const SymmetricEigen one(a), two(a, b);
  EXPECT_LT(Distance(one.values, Eigen::VectorXd::LinSpaced(6, 1, 6)), 1e-12);
  EXPECT_LT(Distance(Times(a, one.vectors), Times(one.vectors, Diagonal(one.values))), 1e-12);
  EXPECT_LT(Distance(Times(a, two.vectors), Times(b, Times(two.vectors, Diagonal(two.values)))),
            1e-12);
  EXPECT_LT(Distance(Propagate(two.vectors.transpose(), b), One(6)), 1e-12);
}

TEST(LinearAlgebra, ASquareRootNeedsNoFullRank) {
  const MatrixXd half = MatrixXd::Random(6, 3), squared = Propagate(half, One(3));
  EXPECT_LT(Distance(Propagate(SquareRoot(squared).transpose(), One(6)), squared), 1e-12);
}

TEST(LinearAlgebra, FindsRotationsFromPointsInSpaceInAPlaneAndOnALine) {
  const MatrixXd rotation = ExpSO3({0.4, -2, 1}).toRotationMatrix();
  MatrixXd points = MatrixXd::Random(3, 10);
  for (const int num_axes : {3, 2, 1}) {
    points.bottomRows(3 - num_axes).setZero();
    const MatrixXd correlation = Propagate(points, One(10));
    const MatrixXd found = FindRotation(Times(rotation, correlation));
    EXPECT_LT(Distance(Times(found, points), Times(rotation, points)), 1e-9) << num_axes;
    EXPECT_LT(Distance(Propagate(found, One(3)), One(3)), 1e-12) << num_axes;
    // Of those that fit alike the smallest.
    EXPECT_LT(Distance(FindRotation(correlation), One(3)), 1e-3) << num_axes;
  }
  EXPECT_LT(Distance(FindRotation(MatrixXd::Zero(3, 3)), One(3)), 1e-12);
  // A mirror image is no rotation.
  EXPECT_NEAR(FindRotation(Diagonal(Eigen::Vector3d(-1, 1, 1))).determinant(), 1, 1e-12);
}

}  // namespace
}  // namespace arfm_vo
