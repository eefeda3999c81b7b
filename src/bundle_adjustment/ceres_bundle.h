#pragma once

#include "arfm_vo/bundle_adjustment/bundle_adjustment.h"
#include "bundle_selection.h"

namespace arfm_vo {

/// Adjusts with Ceres: fills poses, points, correction, its covariance, costs and status.
BundleResult AdjustWithCeres(const BundleProblem& problem, const BundleSelection& selection,
                             const BundleOptions& options, const BundleCallback& callback);

}  // namespace arfm_vo
