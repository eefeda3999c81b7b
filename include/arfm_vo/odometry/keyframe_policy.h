#pragma once

#include <string>

#include "arfm_vo/base/check.h"
#include "arfm_vo/base/fields.h"
#include "arfm_vo/geometry/stereo_camera.h"
#include "arfm_vo/mapping/local_map.h"

namespace arfm_vo {

struct KeyframePolicyOptions {
  double min_parallax_px = 30;       ///< median over the shared points, rotation taken out
  double min_shared_fraction = 0.5;  ///< of the newest keyframe's points still tracked
  int min_tracked_points = 150;      ///< fewer, and fewer than the newest has, call for one

  void Check() const {
    Require(min_parallax_px >= 0, "keyframes.min_parallax_px must not be negative");
    Require(min_shared_fraction >= 0 && min_shared_fraction <= 1,
            "keyframes.min_shared_fraction must be in [0, 1]");
    Require(min_tracked_points >= 0, "keyframes.min_tracked_points must not be negative");
  }
  ARFM_FIELDS(min_parallax_px, min_shared_fraction, min_tracked_points)
};

/// Whether a frame becomes a keyframe: by parallax and overlap with the newest one, not by count.
/// `observations` are the frame's, sorted by landmark.
bool NeedsKeyframe(const StereoCamera& camera, const Keyframe& newest,
                   const Rigid3& camera_from_world, const LandmarkObservations& observations,
                   const KeyframePolicyOptions& options);

}  // namespace arfm_vo
