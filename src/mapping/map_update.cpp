#include "arfm_vo/mapping/map_update.h"

namespace arfm_vo {

const Keyframe* ApplyMapUpdate(const MapUpdate& update, LocalMap& map) {
  const Keyframe* anchor = nullptr;
  Rigid3 anchor_in_map;
  for (const auto& keyframe : update.keyframes) {
    const Keyframe* known = map.FindKeyframe(keyframe.id);
    if (known == nullptr) continue;
    anchor = known;
    anchor_in_map = keyframe.camera_from_world;
  }
  if (anchor == nullptr) return nullptr;
  const size_t num_telling = std::max(1, update.num_keyframes);
  const size_t num_moved = update.keyframes.size();
  map.ForgetRight(update.keyframes[num_moved - std::min(num_moved, num_telling)].id);
  const Rigid3 odom_from_map = anchor->camera_from_world.Inverse() * anchor_in_map;
  const Rigid3 map_from_odom = odom_from_map.Inverse();
  for (const auto& keyframe : update.keyframes) {
    map.MoveKeyframe(keyframe.id, keyframe.camera_from_world * map_from_odom);
  }
  for (const auto& landmark : update.landmarks) {
    const auto known = map.landmarks().find(landmark.id);
    if (known == map.landmarks().end()) continue;
    map.MoveLandmark(landmark.id, odom_from_map * landmark.x_in_world, known->second.covariance);
  }
  return anchor;
}

}  // namespace arfm_vo
