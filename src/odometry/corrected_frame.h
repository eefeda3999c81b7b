#pragma once

#include "arfm_vo/geometry/stereo_camera.h"
#include "arfm_vo/geometry/stereo_correction.h"
#include "arfm_vo/reconstruction/stereo_frame.h"

namespace arfm_vo {

/// The frame with its points where they are when the right image is displaced as `correction` says.
StereoFrame Corrected(StereoFrame frame, const StereoCamera& camera,
                      const StereoCorrection& correction);

/// px; 0 of no points.
double MedianRowResidual(const StereoPoints& points);

}  // namespace arfm_vo
