#include "arfm_vo/ros/odometry/mount_log.h"

#include <algorithm>
#include <iterator>

namespace arfm_vo {
namespace {

/// A camera at rest is told to move by less.
constexpr double kNoise_m = 1e-6, kNoise_rad = 1e-6;

}  // namespace

void MountLog::Add(double stamp_s, const Rigid3& base_from_camera) {
  if (!base_from_camera_.empty()) {
    const Rigid3 change = base_from_camera_.rbegin()->second.Inverse() * base_from_camera;
    if (change.translation.norm() < kNoise_m && change.Angle() < kNoise_rad) return;
  }
  base_from_camera_[stamp_s] = base_from_camera;
  if (base_from_camera_.size() <= kMaxFramesKept) return;
  auto place = base_from_camera_.begin();  // as BoundFrames
  for (size_t i = 0; i < kMaxFramesKept / 4; ++i) place = base_from_camera_.erase(std::next(place));
}

Rigid3 MountLog::At(double stamp_s) const {
  if (base_from_camera_.empty()) return Rigid3();
  const auto after = base_from_camera_.upper_bound(stamp_s);
  return after == base_from_camera_.begin() ? after->second : std::prev(after)->second;
}

Trajectory MountLog::OfBase(const Trajectory& of_camera) const {
  Trajectory of_base = of_camera;
  const auto first = std::find_if(of_camera.begin(), of_camera.end(),
                                  [](const TrajectoryPose& pose) { return pose.is_tracked; });
  if (first == of_camera.end()) return of_base;
  const Rigid3 base_from_world = At(first->stamp_s) * first->world_from_camera.Inverse();
  for (TrajectoryPose& pose : of_base)
    pose.world_from_camera = base_from_world * pose.world_from_camera * At(pose.stamp_s).Inverse();
  InterpolateLostPoses(of_base);
  return of_base;
}

}  // namespace arfm_vo
