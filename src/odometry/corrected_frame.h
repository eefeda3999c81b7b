#pragma once

#include "arfm_vo/geometry/rigid3.h"
#include "arfm_vo/geometry/stereo_camera.h"
#include "arfm_vo/geometry/stereo_correction.h"
#include "arfm_vo/mapping/landmark.h"
#include "arfm_vo/reconstruction/stereo_frame.h"

namespace arfm_vo {

/// The frame with its points where they are when the images are displaced as `correction` says and
/// the right one is taken when the camera has moved by `later_from_now`; its right pixels are moved
/// to where they would be without that motion.
StereoFrame Corrected(StereoFrame frame, const StereoCamera& camera,
                      const StereoCorrection& correction, const Rigid3& later_from_now);

/// px; 0 of no points.
double MedianRowResidual(const StereoPoints& points);
double MedianRowResidual(const LandmarkObservations& observations);

}  // namespace arfm_vo
