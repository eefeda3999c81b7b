#include "arfm_vo/odometry/trajectory_log.h"

#include <algorithm>
#include <iterator>
#include <set>

namespace arfm_vo {

void TrajectoryLog::Add(const OdometryUpdate& update, const LocalMap& map) {
  for (const Keyframe& keyframe : map.keyframes()) {
    const auto [place, is_new] = keyframes_.try_emplace(keyframe.id);
    if (is_new) place->second.frame = first_frame_ + num_frames_;
    place->second.camera_from_world = keyframe.camera_from_world;
  }
  if (!update.pose.IsMeasured() || map.keyframes().empty()) return AddLost(update.stamp_s);
  const Keyframe& keyframe = map.keyframes().back();
  Push({update.stamp_s, true, keyframe.id,
        update.pose.camera_from_world * keyframe.camera_from_world.Inverse()});
}

void TrajectoryLog::Push(const Frame& frame) {
  frames_.push_back(frame);
  ++num_frames_;
  if (frames_.size() <= kMaxFramesKept) return;
  BoundFrames(frames_);
  std::set<KeyframeId> needed;
  for (const Frame& kept : frames_) needed.insert(kept.keyframe);
  const size_t recent = num_frames_ - kMaxFramesKept / 2;  // an adjustment may still come for these
  for (auto place = keyframes_.begin(); place != keyframes_.end();) {
    const bool is_needed =
        place->second.frame >= first_frame_ + recent || needed.count(place->first);
    place = is_needed ? std::next(place) : keyframes_.erase(place);
  }
}

void TrajectoryLog::Apply(const MapUpdate& update) {
  for (const MapUpdate::KeyframePose& keyframe : update.keyframes) {
    const auto known = keyframes_.find(keyframe.id);
    if (known != keyframes_.end()) known->second.camera_from_map = keyframe.camera_from_world;
  }
}

size_t TrajectoryLog::FrameOf(KeyframeId keyframe) const {
  const auto known = keyframes_.find(keyframe);
  return known == keyframes_.end() ? first_frame_ : known->second.frame;
}

Rigid3 TrajectoryLog::MapFromWorld() const {
  const auto newest = std::find_if(
      keyframes_.rbegin(), keyframes_.rend(),
      [](const auto& keyframe) { return keyframe.second.camera_from_map.has_value(); });
  if (newest == keyframes_.rend()) return Rigid3();
  return newest->second.camera_from_map->Inverse() * newest->second.camera_from_world;
}

Trajectory TrajectoryLog::Poses() const {
  const Rigid3 world_from_map = MapFromWorld().Inverse();
  Trajectory trajectory;
  for (const Frame& frame : frames_) {
    TrajectoryPose pose{frame.stamp_s, Rigid3(), frame.is_tracked};
    if (frame.is_tracked) {
      const KeyframePlace& keyframe = keyframes_.at(frame.keyframe);
      const Rigid3 camera_from_map =
          keyframe.camera_from_map.value_or(keyframe.camera_from_world * world_from_map);
      pose.world_from_camera = (frame.camera_from_keyframe * camera_from_map).Inverse();
    }
    trajectory.push_back(pose);
  }
  return trajectory;
}

}  // namespace arfm_vo
