#pragma once

#include <opencv2/core/mat.hpp>

#include "arfm_vo/geometry/rigid3.h"
#include "arfm_vo/mapping/landmark.h"

namespace arfm_vo {

/// A frame that the map keeps: its pose, what it saw, and its left image for the patches.
struct Keyframe {
  KeyframeId id = 0;
  double stamp_s = 0;
  Rigid3 camera_from_world;
  LandmarkObservations observations;  ///< sorted by landmark
  cv::Mat left;                       ///< grey, for templates of patches
};

}  // namespace arfm_vo
