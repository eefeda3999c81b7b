#pragma once

#include <array>
#include <vector>

#include "arfm_vo/geometry/correction_belief.h"
#include "arfm_vo/geometry/rigid3.h"
#include "arfm_vo/geometry/stereo_camera.h"
#include "arfm_vo/mapping/landmark.h"

namespace arfm_vo {

/// A landmark as the global map keeps it: where, and what it looks like.
struct LandmarkRecord {
  LandmarkId id = 0;
  Eigen::Vector3d x_in_world;
  int8_t laplacian_sign = 1;
  std::array<float, 64> descriptor;
};

/// What pose_node tells ba_node of a keyframe: a keyframe without its image.
struct KeyframeRecord {
  KeyframeId id = 0;
  double stamp_s = 0;
  Rigid3 camera_from_world;               ///< world: the odometry's
  LandmarkObservations observations;      ///< sorted by landmark
  std::vector<LandmarkRecord> landmarks;  ///< those that no earlier keyframe saw
};

/// A keyframe, and where the map epoch that it belongs to lies.
struct PlacedKeyframe {
  KeyframeRecord record;
  uint32_t epoch = 0;  ///< counts the maps that the odometry has begun
  StereoCamera camera;
  Rigid3 odom_from_world;
  Rigid3 base_from_camera;  ///< at the keyframe's stamp
};

/// What a global bundle adjustment found; given back to the odometry.
struct MapUpdate {
  struct KeyframePose {
    KeyframeId id = 0;
    Rigid3 camera_from_world;  ///< world: the map's
  };
  struct LandmarkPosition {
    LandmarkId id = 0;
    Eigen::Vector3d x_in_world;  ///< world: the map's
  };
  std::vector<KeyframePose> keyframes;      ///< those that moved, sorted by id; the newest one
  std::vector<LandmarkPosition> landmarks;  ///< those that moved, sorted by id
  CorrectionBelief correction;              ///< what rectification left undone
  int num_keyframes = 0;                    ///< of the map that was adjusted

  /// How many frames after its newest keyframe the odometry takes an update over: a number that
  /// does not depend on how fast the adjustment was, so that a drive can be repeated.
  int TakeoverDelay() const { return 1 + num_keyframes / 10; }
};

}  // namespace arfm_vo
