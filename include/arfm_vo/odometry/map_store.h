#pragma once

#include <map>
#include <vector>

#include "arfm_vo/geometry/rigid3.h"
#include "arfm_vo/mapping/landmark.h"

namespace arfm_vo {

/// All keyframes and points of a world, as the global map keeps them.
struct MapStore {
  struct Point {
    Eigen::Vector3d x_in_map;
    int num_observations = 0;
    int first_keyframe = 0;  ///< index of the keyframe that saw it first
    int last_keyframe = 0;
    int row = -1;             ///< in the bundle problem being solved
    LandmarkId same_as = -1;  ///< an older landmark that it turned out to be; -1: none
    int8_t laplacian_sign = 1;
    std::vector<float> descriptor;  ///< [64]; empty where loops are not looked for
  };
  struct Keyframe {
    KeyframeId id;
    Rigid3 camera_from_map;
    LandmarkObservations observations;
  };
  std::vector<Keyframe> keyframes;
  std::map<LandmarkId, Point> landmarks;

  /// The landmark that `id` is known to be; nothing where it is not known.
  std::map<LandmarkId, Point>::iterator Find(LandmarkId id) {
    auto found = landmarks.find(id);
    while (found != landmarks.end() && found->second.same_as >= 0) {
      found = landmarks.find(found->second.same_as);
    }
    return found;
  }
  std::map<LandmarkId, Point>::const_iterator Find(LandmarkId id) const {
    return const_cast<MapStore*>(this)->Find(id);
  }
};

}  // namespace arfm_vo
