#include "arfm_vo/odometry/trajectory.h"

#include <algorithm>

namespace arfm_vo {
namespace {

Rigid3 Interpolate(const TrajectoryPose& before, const TrajectoryPose& after, double stamp_s) {
  const double span_s = after.stamp_s - before.stamp_s;
  const double part = span_s > 0 ? (stamp_s - before.stamp_s) / span_s : 0;
  const Rigid3 &a = before.world_from_camera, &b = after.world_from_camera;
  return {a.rotation.slerp(part, b.rotation),
          Eigen::Vector3d((1 - part) * a.translation + part * b.translation)};
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
        pose < before ? before->world_from_camera : Interpolate(*before, next, pose->stamp_s);
  }
}

}  // namespace arfm_vo
