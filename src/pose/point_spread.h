#pragma once

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace arfm_vo {

/// The covariance of a point as one long axis in a round rest: what stereo makes of a point, and
/// quick to carry through a projection.
struct PointSpread {
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();  ///< m, world frame
  double rest = 0;                                 ///< m^2, the second largest variance

  explicit PointSpread(const Eigen::Matrix3d& covariance) {
    if (covariance.isZero(0)) return;
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
    solver.computeDirect(covariance);
    rest = std::max(0.0, solver.eigenvalues()[1]);
    axis = std::sqrt(std::max(0.0, solver.eigenvalues()[2] - rest)) * solver.eigenvectors().col(2);
  }
};

}  // namespace arfm_vo
