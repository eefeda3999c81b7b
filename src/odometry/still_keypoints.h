#pragma once

#include <optional>
#include <vector>

#include "arfm_vo/geometry/rigid3.h"
#include "arfm_vo/geometry/stereo_camera.h"
#include "arfm_vo/reconstruction/stereo_frame.h"

namespace arfm_vo {

/// Sets StereoFrame::is_still and rest_log_ratio by the features of the newest keyframe: still is
/// what is fixed to the camera, or all that a resting camera sees. Something fixed may cover a part
/// of the picture, so each of its 4 x 3 regions counts once.
void FlagStill(const StereoCamera& camera, const Features& before, StereoFrame& frame);

struct FixedPoints {
  std::vector<char> is_fixed;   ///< [features] still, though it must have moved in the picture
  std::optional<double> share;  ///< of the points that must have
};

/// What of `frame.points` is fixed before the camera, which has moved so since the newest keyframe;
/// where that is not known all that is still.
FixedPoints FindFixed(const StereoCamera& camera, const StereoFrame& frame,
                      const std::optional<Rigid3>& before_from_now);

}  // namespace arfm_vo
