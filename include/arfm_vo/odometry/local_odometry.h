#pragma once

#include <memory>
#include <optional>

#include "arfm_vo/base/fields.h"
#include "arfm_vo/geometry/stereo_camera.h"
#include "arfm_vo/image/stereo_images.h"
#include "arfm_vo/mapping/local_map.h"
#include "arfm_vo/mapping/map_update.h"
#include "arfm_vo/odometry/keyframe_archive.h"
#include "arfm_vo/odometry/keyframe_policy.h"
#include "arfm_vo/odometry/local_bundle.h"
#include "arfm_vo/odometry/odometry_update.h"
#include "arfm_vo/odometry/standstill_lock.h"
#include "arfm_vo/reconstruction/frame_on_request.h"
#include "arfm_vo/tracking/frame_tracker.h"

namespace arfm_vo {

struct LocalOdometryOptions {
  FrameTrackerOptions tracker;
  KeyframePolicyOptions keyframes;
  LocalMapOptions map;
  LocalBundleOptions bundle;
  StandstillOptions standstill;
  bool predict_motion = true;       ///< constant velocity; never required
  int min_points_to_start = 30;     ///< stereo points of the first frame
  int archived_keyframes = 32;      ///< to look in after a loss; 0: none, beyond the local map
  double restart_after_lost_s = 3;  ///< without a pose: then a new map is begun; 0: never

  void Check() const;
  ARFM_FIELDS(tracker, keyframes, map, bundle, standstill, predict_motion, min_points_to_start,
              archived_keyframes, restart_after_lost_s)
};

/// The pose of each frame against the local map, which it keeps up and refines by windowed bundle
/// adjustment on a thread of its own (layers pose to bundle_adjustment). A frame that the map does
/// not know is looked for in the keyframes that left it; where it is found the map begins anew.
/// What Session runs.
/// The world is the left camera of the first frame after construction or Reset.
class LocalOdometry {
 public:
  /// `correction`: what is known of it at first.
  LocalOdometry(const StereoCamera& camera, const LocalOdometryOptions& options,
                const CorrectionBelief& correction);
  ~LocalOdometry();

  /// Localises the next frame, later than the one before; `images` are those it was made from,
  /// `predicted`, never required, is where it may be. The frame's features are asked for where
  /// patches near the prediction do not tell the pose, or a keyframe is made.
  OdometryUpdate Process(const FrameOnRequest& frame, const StereoImages& images,
                         const std::optional<PredictedPose>& predicted);

  /// Improves the local map by a global adjustment. The newest keyframe that both know stays where
  /// it is, so that the pose does not jump.
  void Apply(const MapUpdate& update);

  /// Forgets the map; the next frame starts a new world.
  void Reset();

  const LocalMap& map() const;
  /// Keyframe::step_covariance of the newest.
  const Eigen::Matrix<double, 6, 6>& step_covariance() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace arfm_vo
