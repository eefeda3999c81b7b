#pragma once

#include <vector>

#include "arfm_vo/geometry/stereo_camera.h"
#include "arfm_vo/mapping/keyframe.h"

namespace arfm_vo {

/// What pose_node tells ba_node: a keyframe, and where the map epoch that it belongs to lies.
struct PlacedKeyframe {
  Keyframe keyframe;                ///< without its image
  std::vector<Landmark> landmarks;  ///< those that no earlier keyframe saw, sorted by id
  uint32_t epoch = 0;               ///< counts the maps that the odometry has begun
  StereoCamera camera;
  Rigid3 odom_from_world;
  Rigid3 base_from_camera;  ///< at the keyframe's stamp
};

}  // namespace arfm_vo
