#pragma once

#include <vector>

#include "arfm_vo/bundle_adjustment/bundle_problem.h"

namespace arfm_vo {

/// What of a problem takes part in its adjustment.
struct BundleSelection {
  std::vector<char> observation_is_used;  ///< its point is used and in front of the camera
  std::vector<char> point_is_used;        ///< seen in stereo, or by two poses
  std::vector<char> pose_is_free;         ///< not fixed, and tied to a fixed pose
  /// [coefficients x N] the directions in which the correction is free.
  using Directions = Eigen::Matrix<double, StereoCorrection::kSize, Eigen::Dynamic, Eigen::ColMajor,
                                   StereoCorrection::kSize, StereoCorrection::kSize>;
  Directions correction_directions = Directions(StereoCorrection::kSize, 0);

  BundleSelection() = default;
  /// The correction is free where it has a prior.
  explicit BundleSelection(const BundleProblem& problem);
};

}  // namespace arfm_vo
