#pragma once

#include "arfm_vo/pose/pose_estimator.h"

namespace arfm_vo {

/// A place is not known again by a few points that fit by chance.
inline PoseEstimatorOptions RecognitionPose() {
  PoseEstimatorOptions options;
  options.min_inliers = 25;
  options.min_inlier_share = 0.25;
  options.sample_size = 4;
  options.ransac.max_iterations = 1800;  // finds a quarter that agrees with a probability of 0.999
  return options;
}

}  // namespace arfm_vo
