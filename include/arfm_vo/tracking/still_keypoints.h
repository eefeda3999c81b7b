#pragma once

#include <optional>
#include <vector>

#include "arfm_vo/geometry/rigid3.h"
#include "arfm_vo/geometry/stereo_camera.h"
#include "arfm_vo/reconstruction/stereo_frame.h"
#include "arfm_vo/tracking/correspondences.h"

namespace arfm_vo {

/// Sets StereoFrame::is_still by the features of the newest keyframe: still is what is fixed to the
/// camera, or all that a resting camera sees.
void FlagStill(const Features& before, StereoFrame& frame);

/// How much likelier what is still is where the camera rests than where it has moved, in
/// logarithms. Something fixed may cover a part of the picture, so each of its 4 x 3 regions counts
/// once; and what lies far away moves by less than a keypoint errs, so that a region counts as
/// still by the share of its `matches` whose flag (`agrees`, [N]) is `flag` besides: those of the
/// resting pose.
double RestLogRatio(const StereoCamera& camera, const StereoFrame& frame,
                    const Correspondences& matches, const std::vector<char>& agrees, char flag);
/// The same by landmarks alone: what of those in view of the resting pose (`camera_from_world`) is
/// among `seen` there (sorted by landmark) is still.
double RestLogRatio(const StereoCamera& camera, const std::vector<const Landmark*>& in_view,
                    const Rigid3& camera_from_world, const LandmarkObservations& seen);

}  // namespace arfm_vo
