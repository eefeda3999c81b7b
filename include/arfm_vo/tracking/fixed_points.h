#pragma once

#include <optional>
#include <vector>

#include "arfm_vo/geometry/rigid3.h"
#include "arfm_vo/geometry/stereo_camera.h"
#include "arfm_vo/pose/pose_refinement.h"
#include "arfm_vo/reconstruction/stereo_frame.h"
#include "arfm_vo/tracking/correspondences.h"

namespace arfm_vo {

/// Those of `frame.points` that are fixed before the camera: still, though they must have moved in
/// the picture as the camera has moved since the newest keyframe.
struct FixedPoints {
  /// Where the camera's motion is not known all that is still is taken to be fixed.
  FixedPoints(const StereoCamera& camera, const StereoFrame& frame,
              const std::optional<Rigid3>& before_from_now);
  void RemoveFrom(StereoFrame& frame) const;

  std::vector<char> is_fixed;   ///< [features]
  std::optional<double> share;  ///< of the points that must have moved; where the motion is known
};

/// A pose of what is not fixed before the camera, and how much better than the first pose alone it
/// explains the image: logarithms of likelihood ratios, each of the image's regions once.
struct PoseWithoutFixed {
  PoseRefinement refined;       ///< in `is_inlier` [N] what is likelier fixed has kAgreesWithRival
  double with_fixed = 0;        ///< this pose and what is fixed
  double first_with_fixed = 0;  ///< the first pose and what is fixed
  double both_poses = 0;        ///< the poses of two groups that move differently

  /// Log odds of the first of these against the other two and the first pose alone, where
  /// something is fixed, and something large moves on its own, with these log odds.
  double LogOdds(double fixed_log_odds, double another_log_odds) const;
};

/// What is fixed before the camera (a part of the rover, a projector's dots) agrees, together with
/// far points, with a pose between that of the ground and none at all. Where most regions of the
/// image that agree with a pose (`agrees` [N] 1) are not where they were seen first, but at least
/// one is: the pose of what is not. None where that is agreement by chance.
std::optional<PoseWithoutFixed> FindPoseWithoutFixed(const StereoCamera& camera,
                                                     const Correspondences& matches,
                                                     const std::vector<char>& agrees,
                                                     const Rigid3& camera_from_world,
                                                     const PoseRefinementOptions& options);

}  // namespace arfm_vo
