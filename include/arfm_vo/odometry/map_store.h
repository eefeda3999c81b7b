#pragma once

#include <map>
#include <vector>

#include "arfm_vo/mapping/keyframe.h"
#include "arfm_vo/mapping/known_map.h"
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
  /// The first ones as Forget found them, where they are to be known later; frame 0.
  std::vector<KnownKeyframe> settled;

  /// The landmark that `id` is known to be; nothing where it is not known.
  std::map<LandmarkId, Point>::iterator Find(LandmarkId id);
  std::map<LandmarkId, Point>::const_iterator Find(LandmarkId id) const;

  /// What the newest keyframe sees, all of it landmarks.
  std::vector<SeenPoint> NewestView(const StereoCamera& camera,
                                    const StereoCorrection& correction) const;
  /// What keyframe `k` (an index) saw that others saw too, as it is known now or was when it
  /// settled; where that is too little to be recognised, all that it saw.
  Place PlaceOf(int k) const;

  /// Forgets what says nothing of the keyframes from `first_moving` on: observations by older ones
  /// of landmarks that those do not see, all by the keyframes before `oldest`, and, unless
  /// `keep_landmarks`, those landmarks. To be called for each keyframe that is added. With
  /// `max_settled_points` what they show is kept in `settled`, of those that differ.
  void Forget(int first_moving, int oldest, bool keep_landmarks, size_t max_settled_points = 0);
};

}  // namespace arfm_vo
