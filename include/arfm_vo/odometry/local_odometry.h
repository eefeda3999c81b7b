#pragma once

#include <memory>
#include <optional>

#include "arfm_vo/geometry/stereo_camera.h"
#include "arfm_vo/image/stereo_images.h"
#include "arfm_vo/mapping/keyframe_record.h"
#include "arfm_vo/mapping/local_map.h"
#include "arfm_vo/odometry/odometry_update.h"
#include "arfm_vo/reconstruction/stereo_frame.h"

namespace arfm_vo {

/// The pose of each frame against the local map, which it keeps up and refines by windowed bundle
/// adjustment on a thread of its own (floors pose to bundle_adjustment). What pose_node runs.
/// The world is the left camera of the first frame after construction or Reset.
class LocalOdometry {
 public:
  LocalOdometry(const StereoCamera& camera, const LocalOdometryOptions& options);
  ~LocalOdometry();

  /// Localises the next frame, later than the one before; `images` are those it was made from.
  OdometryUpdate Process(const StereoFrame& frame, const StereoImages& images);

  /// The record of the newest keyframe, once: nothing where no keyframe was added since.
  std::optional<KeyframeRecord> TakeKeyframe();

  /// Improves the local map by a global adjustment. The newest keyframe that both know stays where
  /// it is, so that the pose does not jump.
  void Apply(const MapUpdate& update);

  /// Forgets the map; the next frame starts a new world.
  void Reset();

  const LocalMap& map() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace arfm_vo
