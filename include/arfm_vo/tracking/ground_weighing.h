#pragma once

#include <functional>
#include <vector>

#include "arfm_vo/geometry/stereo_camera.h"
#include "arfm_vo/mapping/local_map.h"
#include "arfm_vo/tracking/tracked_frame.h"

namespace arfm_vo {

/// Log odds that a pose is the ground's from which no rival is looked for.
constexpr double kSure = 2;

/// Whether two poses (camera from world) have the landmarks at the same place of the picture, to
/// half a pixel as a rule.
bool IsSame(const StereoCamera& camera, const std::vector<const Landmark*>& landmarks,
            const Rigid3& pose, const Rigid3& other);

/// Sets how likely a frame's pose and its rival are the ground's, by its matches. `rest_log_ratio`:
/// how much likelier what is still in the picture is at rest; of a pose whose matches have this
/// flag, and which has not moved since the newest keyframe.
void WeighGround(const StereoCamera& camera, const LocalMap& map, const Expectation& expected,
                 const std::function<double(char flag)>& rest_log_ratio, TrackedFrame& tracked);

/// Sets which matches agree with neither pose, and which with the rival.
void SortMatches(TrackedFrame& tracked);

}  // namespace arfm_vo
