#pragma once

#include <vector>

#include "arfm_vo/bundle_adjustment/bundle_problem.h"

namespace arfm_vo {

/// Moves all poses but the first, which stays, to the least of
///   sum_c e_c^T Omega_c e_c + sum_l s_l^2 e_l^T Omega_l e_l
/// with e the errors of the steps c and the loops l (ConstraintTerm): Gauss-Newton with a sparse
/// Cholesky factorisation. Loops count in full at first, s = 1; where they then still contradict
/// the others, they count less: s = min(1, 2 Phi / (Phi + e_l^T Omega_l e_l)), Phi the 99 %
/// quantile (dynamic covariance scaling: Agarwal et al., ICRA 2013). Returns the poses, and `loops`
/// with their information scaled by s^2. Poses stay where the constraints do not tie all of them
/// together. Throws std::invalid_argument for a pose that is not there.
std::vector<Rigid3> SolvePoseGraph(const std::vector<Rigid3>& camera_from_world,
                                   const std::vector<PoseConstraint>& steps,
                                   std::vector<PoseConstraint>& loops);

/// [6 x 6] the covariance of the error (ConstraintTerm, rad and m) that a `next` constraint without
/// any of its own would have at these poses, by that of the steps and loops. NaN where these do not
/// tie all poses together. Throws std::invalid_argument for a pose that is not there.
Eigen::Matrix<double, 6, 6> FindErrorCovariance(const std::vector<Rigid3>& camera_from_world,
                                                const std::vector<PoseConstraint>& steps,
                                                const std::vector<PoseConstraint>& loops,
                                                const PoseConstraint& next);

}  // namespace arfm_vo
