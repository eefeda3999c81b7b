#pragma once

#include <vector>

#include "arfm_vo/bundle_adjustment/bundle_problem.h"

namespace arfm_vo {

/// What of a problem takes part in its adjustment.
struct BundleSelection {
  std::vector<char> observation_is_used;  ///< its point is used and in front of the camera
  std::vector<char> point_is_used;        ///< seen in stereo, or by two poses
  std::vector<char> pose_is_free;         ///< not fixed, and tied to a fixed pose
  int num_free_coefficients = 0;          ///< of the correction, the first ones; or its turns

  BundleSelection() = default;
  /// The correction is free where it has a prior.
  explicit BundleSelection(const BundleProblem& problem);
};

}  // namespace arfm_vo
