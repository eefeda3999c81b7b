#pragma once

#include <map>
#include <vector>

#include "arfm_vo/mapping/keyframe.h"
#include "arfm_vo/matching/appearance.h"

namespace arfm_vo {

/// The keyframes and points of a world, as the global map keeps them.
struct MapStore {
  struct Point {
    Eigen::Vector3d x_in_world;
    int num_observations = 0;
    int first_keyframe = 0;  ///< index of the keyframe that saw it first
    int last_keyframe = 0;
    int row = -1;             ///< in the bundle problem being solved
    LandmarkId same_as = -1;  ///< an older landmark that it turned out to be; -1: none
    Appearance appearance;
  };
  std::vector<Keyframe> keyframes;  ///< world: the map
  std::map<LandmarkId, Point> landmarks;
  int first_seeing = 0;  ///< keyframes before it are poses alone: what they saw is forgotten

  /// The landmark that `id` is known to be; nothing where it is not known.
  std::map<LandmarkId, Point>::iterator Find(LandmarkId id);
  std::map<LandmarkId, Point>::const_iterator Find(LandmarkId id) const;

  /// Forgets what says nothing of the keyframes from `first_moving` on: observations by older ones
  /// of landmarks that those do not see, all by the keyframes before `oldest`, and, unless
  /// `keep_landmarks`, those landmarks. To be called for each keyframe that is added.
  void Forget(int first_moving, int oldest, bool keep_landmarks);
};

}  // namespace arfm_vo
