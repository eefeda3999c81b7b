#pragma once

#include <optional>
#include <string>
#include <vector>

#include "arfm_vo/geometry/correction_belief.h"
#include "arfm_vo/geometry/rigid3.h"
#include "arfm_vo/mapping/place_recogniser.h"

namespace arfm_vo {

/// A keyframe of a drive, or part of one, that is over.
struct KnownKeyframe {
  double stamp_s = 0;
  Rigid3 map_from_camera, base_from_camera;
  int frame = 0;          ///< keyframes of the same number lie in one map frame
  Place points;           ///< what it saw that others saw too; empty: a place of the path alone
  double distance_m = 0;  ///< of the points, the median

  /// Sets them, and their distance. So few that nothing could be recognised by them are none.
  void SetPoints(Place seen);
};

/// What drives leave to those that follow.
struct KnownMap {
  std::string frame_id;
  StereoCamera camera;
  std::optional<CorrectionBelief> correction;  ///< what was learnt of the camera
  std::vector<KnownKeyframe> keyframes;
};

size_t NumPoints(const std::vector<KnownKeyframe>& keyframes);

/// Of its points from the camera, m; the place must have some.
double MedianDistance(const Place& place);

/// How differently two cameras see points at this distance: the angle between them plus that by
/// which the scene shifts, rad.
inline double ViewDifference(const Rigid3& b_from_a, double distance_m) {
  return b_from_a.Angle() + b_from_a.translation.norm() / distance_m;
}

/// Of keyframes that see much the same, the oldest keeps its points, and those before `first` do.
void KeepDistinct(std::vector<KnownKeyframe>& keyframes, size_t first);

/// Leaves at most `max_points`: the more alike keyframes are, the sooner points of one go.
void KeepAtMost(size_t max_points, std::vector<KnownKeyframe>& keyframes);

}  // namespace arfm_vo
