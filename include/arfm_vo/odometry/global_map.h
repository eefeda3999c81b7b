#pragma once

#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "arfm_vo/geometry/stereo_camera.h"
#include "arfm_vo/mapping/keyframe_record.h"

namespace arfm_vo {

/// All keyframes and points, for the global bundle adjustment (Fig. 4). What ba_node runs.
class GlobalMap {
 public:
  GlobalMap(const StereoCamera& camera, const GlobalMapOptions& options);

  /// Takes the next keyframe, which must be newer than all before.
  void Add(const KeyframeRecord& keyframe);

  /// Adjusts everything. Nothing where there are fewer than two keyframes or no solution.
  /// `progress(iteration, cost)` is called after each iteration; false from it cancels.
  std::optional<MapUpdate> Adjust(const std::function<bool(int, double)>& progress = {});

  /// map_from_odom: what takes the newest adjusted keyframe's pose in odom to that in the map.
  Rigid3 MapFromOdom() const;

  void Clear();
};

}  // namespace arfm_vo
