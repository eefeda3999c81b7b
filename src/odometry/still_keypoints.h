#pragma once

#include <optional>
#include <vector>

#include "arfm_vo/geometry/rigid3.h"
#include "arfm_vo/geometry/stereo_camera.h"
#include "arfm_vo/reconstruction/stereo_frame.h"

namespace arfm_vo {

/// Keypoints of one and the same place are no further from one another than this, px.
inline double StillReach(const Keypoint& keypoint) { return 3 * kKeypointSigma * keypoint.scale; }

/// [now] which keypoints look as one of `before` at the same place of the picture, within what
/// keypoints err: what is fixed to the camera, or all that a resting camera sees.
std::vector<char> FindStill(const Features& before, const Features& now, int width, int height);

/// How much likelier it is by these flags that the camera rests than that it has moved, while
/// something fixed before it may cover a part of the picture; in logarithms. Each of 4 x 3 regions
/// counts once. Without keypoints of before (all flags 0) it is as likely.
double RestLogRatio(const Features& now, const std::vector<char>& is_still, int width, int height);

/// Sets StereoFrame::is_still and rest_log_ratio by the features of the newest keyframe.
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
