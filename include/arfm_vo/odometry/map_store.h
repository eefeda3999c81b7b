#pragma once

#include <functional>
#include <map>
#include <utility>
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
    Appearance appearance;
  };
  struct Keyframe {
    KeyframeId id = 0;
    Rigid3 camera_from_world;           ///< world: the map
    LandmarkObservations observations;  ///< sorted by landmark
  };
  std::vector<Keyframe> keyframes;
  std::map<LandmarkId, Point> landmarks;
  int first_seeing = 0;  ///< keyframes before it are poses alone: what they saw is forgotten
  /// The first ones as Settle found them, where they are to be known later; frame 0.
  std::vector<KnownKeyframe> settled;

  /// Landmarks, sorted by id.
  using Rows = std::vector<std::pair<LandmarkId, const Point*>>;
  /// Those that the keyframes from `first` on see, and so many in all.
  Rows SeenFrom(int first, int min_observations) const;

  /// camera_from_world of the keyframes.
  std::vector<Rigid3> Poses() const;
  /// What the newest keyframe sees, all of it landmarks.
  std::vector<SeenPoint> NewestView(const StereoCamera& camera,
                                    const StereoCorrection& correction) const;
  /// What keyframe `k` (an index) saw that others saw too, as it is known now or was last; where
  /// that is too little to be recognised, all that it saw.
  Place PlaceOf(int k) const;

  /// Keeps what the keyframes before `first_unsettled` show, of those that differ, in `settled`, of
  /// at most `max_points` points, and forgets what one of them alone has seen. To be called for
  /// each keyframe that is added.
  void Settle(int first_unsettled, size_t max_points);
  /// Forgets what says nothing of the keyframes from `first_moving` on: observations by older ones
  /// of landmarks that those do not see, those landmarks, and all by the keyframes before `oldest`.
  /// To be called for each keyframe that is added.
  void Forget(int first_moving, int oldest);

 private:
  /// What keyframe `k` saw of landmarks that are over, and these.
  void Forget(int k, const std::function<bool(const Point&)>& is_over);
};

}  // namespace arfm_vo
