#pragma once

#include "arfm_vo/mapping/local_map.h"
#include "arfm_vo/odometry/frame_tracker.h"

namespace arfm_vo {

/// Whether both eyes tell the depth of half of the points well enough to tell how long the way is.
/// Where they do not the pose looks certain all the same: looming tells the way in proportion to
/// the depths, and the errors of these are no longer small, nor independent.
bool AreDepthsKnown(const StereoCamera& camera, const LocalMap& map, const TrackedFrame& tracked);

}  // namespace arfm_vo
