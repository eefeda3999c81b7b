#pragma once

#include "arfm_vo/bundle_adjustment/bundle_adjustment.h"
#include "bundle_structure.h"

namespace arfm_vo {

/// Adjusts by Levenberg-Marquardt on our own normal equations: fills poses, points, correction,
/// costs and status. What Ceres does, without its generality.
BundleResult AdjustWithSchur(const BundleProblem& problem, const BundleSelection& selection,
                             const BundleStructure& structure, const BundleOptions& options,
                             const BundleCallback& callback);

}  // namespace arfm_vo
