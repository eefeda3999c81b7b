#include "arfm_vo/odometry/trajectory.h"

#include <algorithm>

#include "arfm_vo/geometry/screw_motion.h"

namespace arfm_vo {
namespace {

/// So long a camera is taken to go on as it went; between pairs further apart it goes straight.
constexpr double kMaxGoingOn_s = 2;

/// Where a camera is at `stamp_s` that goes on from `pose` as between `pose` and its neighbour.
Rigid3 GoOn(const TrajectoryPose& pose, const TrajectoryPose& neighbour, double stamp_s) {
  const double ratio = (stamp_s - pose.stamp_s) / (neighbour.stamp_s - pose.stamp_s);
  const Rigid3 motion = pose.world_from_camera.Inverse() * neighbour.world_from_camera;
  return pose.world_from_camera * ScrewMotion(motion, ratio);
}

/// The pose at `stamp_s` between the frames `before` and `after`, the nearest that are tracked.
Rigid3 InterpolateAt(const Trajectory& trajectory, size_t before, size_t after, double stamp_s) {
  const TrajectoryPose &a = trajectory[before], &b = trajectory[after];
  const double span_s = b.stamp_s - a.stamp_s;
  const double share = span_s > 0 ? (stamp_s - a.stamp_s) / span_s : 0;
  const bool knows_motion = before > 0 && trajectory[before - 1].is_tracked &&
                            after + 1 < trajectory.size() && trajectory[after + 1].is_tracked;
  if (!knows_motion || span_s > kMaxGoingOn_s) {
    return Interpolate(a.world_from_camera, b.world_from_camera, share);
  }
  return Interpolate(GoOn(a, trajectory[before - 1], stamp_s),
                     GoOn(b, trajectory[after + 1], stamp_s), share * share * (3 - 2 * share));
}

}  // namespace

void InterpolateLostPoses(Trajectory& trajectory) {
  const size_t end = trajectory.size();
  size_t before = end, after = 0;  // the nearest that are tracked; end: none
  for (size_t i = 0; i < end; ++i) {
    if (trajectory[i].is_tracked) {
      before = i;
      continue;
    }
    while (after < end && (after < i || !trajectory[after].is_tracked)) ++after;
    Rigid3& pose = trajectory[i].world_from_camera;
    if (before < end && after < end) {
      pose = InterpolateAt(trajectory, before, after, trajectory[i].stamp_s);
    } else if (before < end || after < end) {
      pose = trajectory[std::min(before, after)].world_from_camera;
    }
  }
}

}  // namespace arfm_vo
