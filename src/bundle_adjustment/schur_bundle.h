#pragma once

#include "arfm_vo/bundle_adjustment/bundle_adjustment.h"
#include "normal_equations.h"

namespace arfm_vo {

/// Adjusts by Levenberg-Marquardt on our own normal equations: fills poses, points, correction,
/// costs and status, and leaves `equations` set up at the result. What Ceres does, without its
/// generality.
BundleResult AdjustWithSchur(const BundleProblem& problem, const BundleOptions& options,
                             const BundleCallback& callback, NormalEquations& equations);

}  // namespace arfm_vo
