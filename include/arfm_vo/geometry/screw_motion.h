#pragma once

#include "arfm_vo/geometry/rigid3.h"

namespace arfm_vo {

/// Jl with Exp(omega + d) = Exp(Jl d) Exp(omega) to first order, and ExpSE3(omega, v) =
/// (Exp(omega), Jl v) (Chirikjian 2012, 10.86).
Eigen::Matrix3d LeftJacobianSO3(const Eigen::Vector3d& omega);

/// A motion `times` times as long as `motion`: on along the same screw, so that what drives a curve
/// stays on it. Twice is motion * motion, -1 times its inverse; rotations below pi.
Rigid3 ScrewMotion(const Rigid3& motion, double times);

}  // namespace arfm_vo
