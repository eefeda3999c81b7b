#pragma once

#include <vector>

#include "arfm_vo/geometry/rigid3.h"

namespace arfm_vo {

/// The pose of the left camera at one frame; the world is the first frame's left camera.
struct TrajectoryPose {
  double stamp_s = 0;
  Rigid3 world_from_camera;
  /// False where the frame was lost; its pose is then interpolated between its neighbours (held at
  /// an end).
  bool is_tracked = true;
};
using Trajectory = std::vector<TrajectoryPose>;

/// Sets the poses of the lost frames: from the way the camera went before to the way it went after
/// where that is at most two seconds and both are known, else straight by stamp (slerp); held at an
/// end. Where no frame was tracked nothing changes.
void InterpolateLostPoses(Trajectory& trajectory);

}  // namespace arfm_vo
