#pragma once

#include <Eigen/Core>

#include "arfm_vo/bundle_adjustment/bundle_adjustment.h"

namespace arfm_vo {

/// What the observations of an adjusted bundle say of its poses, fixed ones too, with the points
/// eliminated (the Schur complement): [6P x 6P], (rad, m)^-2, in the steps of BoxPlus, at the
/// result and with the weights of `options`. The block of some poses is the inverse of their
/// covariance given all others; the whole is singular, as nothing ties it to the world.
Eigen::MatrixXd FindPoseInformation(const BundleProblem& problem, const BundleResult& result,
                                    const BundleOptions& options);

}  // namespace arfm_vo
