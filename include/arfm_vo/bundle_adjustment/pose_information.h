#pragma once

#include <Eigen/Core>

#include "arfm_vo/bundle_adjustment/bundle_adjustment.h"

namespace arfm_vo {

/// What the observations of an adjusted bundle say of its poses, fixed ones too, with the points
/// eliminated (the Schur complement), in the steps of BoxPlus, (rad, m).
struct PoseInformation {
  /// [6P x 6P]. The block of some poses is the inverse of their covariance given all others; the
  /// whole is singular, as nothing ties it to the world.
  Eigen::MatrixXd poses;
  /// [6P x StereoCorrection::kNumPlacing], px^-1: the same between the poses and the coefficients
  /// of the correction that move points, which the adjustment holds.
  Eigen::MatrixXd by_correction;
};

/// At the result and with the weights of `options`.
PoseInformation FindPoseInformation(const BundleProblem& problem, const BundleResult& result,
                                    const BundleOptions& options);

}  // namespace arfm_vo
