#pragma once

#include <vector>

#include "arfm_vo/bundle_adjustment/bundle_problem.h"

namespace arfm_vo {

/// Moves all poses but the first, which stays, to the least of
///   sum_c e_c^T Omega_c e_c
/// with e the errors of the constraints (ConstraintTerm): Gauss-Newton with a sparse Cholesky
/// factorisation. Returns `camera_from_world` where that does not lower the sum or the constraints
/// do not tie all poses together. Throws std::invalid_argument for a pose that is not there.
std::vector<Rigid3> SolvePoseGraph(const std::vector<Rigid3>& camera_from_world,
                                   const std::vector<PoseConstraint>& constraints,
                                   int max_iterations = 20);

}  // namespace arfm_vo
