#pragma once

#include <algorithm>
#include <vector>

#include "arfm_vo/geometry/correction_belief.h"
#include "arfm_vo/mapping/local_map.h"

namespace arfm_vo {

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
  std::vector<KeyframePose> keyframes;      ///< those that moved or are new, sorted by id
  std::vector<LandmarkPosition> landmarks;  ///< those that moved, sorted by id
  CorrectionBelief correction;              ///< what rectification left undone
  int num_keyframes = 0;                    ///< the newest ones, that are of this correction

  static constexpr int kMostMoving = 110;  ///< more keyframes take no more time

  /// How many frames after its newest keyframe the odometry takes an update over: a number that
  /// does not depend on how fast the adjustment was, so that a drive can be repeated.
  int TakeoverDelay() const { return 1 + std::min(num_keyframes, kMostMoving) / 10; }
};

/// Moves keyframes and landmarks to where a global adjustment found them, against the newest
/// keyframe that both know, which it returns: that one stays where it is. Null, and nothing moves,
/// where there is none. Keyframes before the first of the update's, and before the newest
/// `num_keyframes`, are of another correction: what their right camera saw is forgotten.
const Keyframe* ApplyMapUpdate(const MapUpdate& update, LocalMap& map);

}  // namespace arfm_vo
