#pragma once

#include <Eigen/Core>

namespace arfm_vo {

/// A matrix whose size is known at run time, without a heap.
using UpTo12x12 = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 12, 12>;

/// The eigenvectors of a symmetric matrix, that of the smallest eigenvalue first. In a source of
/// its own, as GCC takes seconds for each type of matrix.
UpTo12x12 FindEigenvectors(const UpTo12x12& symmetric);

}  // namespace arfm_vo
