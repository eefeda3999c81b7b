#include "arfm_vo/odometry/trajectory.h"

#include <algorithm>

namespace arfm_vo {
namespace {

/// The pose at `stamp_s` between two frames.
Rigid3 InterpolateAt(const TrajectoryPose& before, const TrajectoryPose& after, double stamp_s) {
  const double span_s = after.stamp_s - before.stamp_s;
  return Interpolate(before.world_from_camera, after.world_from_camera,
                     span_s > 0 ? (stamp_s - before.stamp_s) / span_s : 0);
}

}  // namespace

void InterpolateLostPoses(Trajectory& trajectory) {
  const auto is_tracked = [](const TrajectoryPose& pose) { return pose.is_tracked; };
  auto after = std::find_if(trajectory.begin(), trajectory.end(), is_tracked);
  if (after == trajectory.end()) return;
  auto before = after;
  for (auto pose = trajectory.begin(); pose != trajectory.end(); ++pose) {
    if (pose->is_tracked) {
      before = pose;
      continue;
    }
    if (after <= pose) after = std::find_if(pose, trajectory.end(), is_tracked);
    const auto& next = after == trajectory.end() ? *before : *after;
    pose->world_from_camera =
        pose < before ? before->world_from_camera : InterpolateAt(*before, next, pose->stamp_s);
  }
}

}  // namespace arfm_vo
