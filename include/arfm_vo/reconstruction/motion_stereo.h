#pragma once

#include "arfm_vo/features/features.h"
#include "arfm_vo/geometry/rigid3.h"
#include "arfm_vo/geometry/stereo_correction.h"
#include "arfm_vo/reconstruction/stereo_point.h"

namespace arfm_vo {

/// Features of a left image, and where its camera was.
struct PosedFeatures {
  Features features;
  Rigid3 camera_from_world;
};

/// Points of the left image `now` that are found again in `before`, placed by the motion between
/// them; for a pair whose right image is not to be used. Their has_right is false, and their
/// sigma_px is that of a disparity that would place them as well. `keypoint_sigma`: of a keypoint's
/// position, in units of its scale. Points whose depth would be unsure by more than a tenth are
/// left out.
StereoPoints TriangulateByMotion(const StereoCamera& camera, const StereoCorrection& correction,
                                 const PosedFeatures& now, const PosedFeatures& before,
                                 double keypoint_sigma);

}  // namespace arfm_vo
