#pragma once

#include <algorithm>
#include <vector>

#include "arfm_vo/mapping/placed_keyframe.h"
#include "bundle_adjustment/bundle_scene.h"

namespace arfm_vo {

constexpr int kNumKeyframes = 60;

/// A drive along a corridor with drift, as an odometry tells of it, keyframe by keyframe.
inline std::vector<PlacedKeyframe> MakeKeyframes(const CorridorScene& scene) {
  std::vector<PlacedKeyframe> keyframes(scene.camera_from_world.size());
  std::vector<int> first_seen(scene.points.size(), kNumKeyframes);
  for (const BundleObservation& seen : scene.problem.observations)
    first_seen[seen.point] = std::min(first_seen[seen.point], seen.pose);
  for (size_t k = 0; k < keyframes.size(); ++k) {
    keyframes[k].keyframe.id = static_cast<KeyframeId>(k);
    keyframes[k].keyframe.stamp_s = static_cast<double>(k);
    keyframes[k].keyframe.camera_from_world = scene.problem.camera_from_world[k];
  }
  for (const BundleObservation& seen : scene.problem.observations)
    keyframes[seen.pose].keyframe.observations.push_back({seen, seen.point});
  for (size_t i = 0; i < scene.points.size(); ++i) {
    if (first_seen[i] == kNumKeyframes) continue;
    Landmark landmark;
    landmark.id = static_cast<LandmarkId>(i);
    landmark.x_in_world = scene.problem.points[i];
    keyframes[first_seen[i]].landmarks.push_back(landmark);
  }
  return keyframes;
}

}  // namespace arfm_vo
