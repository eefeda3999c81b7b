#pragma once

#include "arfm_vo/bundle_adjustment/bundle_adjustment.h"
#include "normal_equations.h"

namespace arfm_vo {

/// Fills is_inlier, point_is_used and scale of an adjusted bundle, and the covariances where the
/// correction is free or the options ask for them. `equations` are set up at the result.
void AssessBundle(const BundleProblem& problem, const BundleSelection& selection,
                  const BundleStructure& structure, const BundleOptions& options,
                  NormalEquations& equations, BundleResult& result);

}  // namespace arfm_vo
