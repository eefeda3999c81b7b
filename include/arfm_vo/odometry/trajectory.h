#pragma once

#include <cstddef>
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

/// So many frames are kept one by one, hours at 10 Hz (some 20 MB); of longer drives the older half
/// is thinned again and again.
constexpr size_t kMaxFramesKept = 200'000;

/// Every second frame of the older half goes where there are more than are kept.
template <class Frame>
void BoundFrames(std::vector<Frame>& frames) {
  if (frames.size() <= kMaxFramesKept) return;
  const size_t half = frames.size() / 2;
  size_t kept = 0;
  for (size_t i = 0; i < frames.size(); ++i) {
    if (i >= half || i % 2 == 0) frames[kept++] = frames[i];
  }
  frames.erase(frames.begin() + static_cast<std::ptrdiff_t>(kept), frames.end());
}

/// Sets the poses of the lost frames: from the way the camera went before to the way it went after
/// where that is at most two seconds and both are known, else straight by stamp (slerp); held at an
/// end. Where no frame was tracked nothing changes.
void InterpolateLostPoses(Trajectory& trajectory);

}  // namespace arfm_vo
