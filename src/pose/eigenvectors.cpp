#include "eigenvectors.h"

#include <Eigen/Eigenvalues>

namespace arfm_vo {

UpTo12x12 FindEigenvectors(const UpTo12x12& symmetric) {
  return Eigen::SelfAdjointEigenSolver<UpTo12x12>(symmetric).eigenvectors();
}

}  // namespace arfm_vo
