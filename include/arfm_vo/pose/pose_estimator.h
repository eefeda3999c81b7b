#pragma once

#include <optional>
#include <vector>

#include "arfm_vo/base/ransac.h"
#include "arfm_vo/pose/pose_estimate.h"
#include "arfm_vo/pose/pose_refinement.h"

namespace arfm_vo {

struct PoseEstimatorOptions {
  RansacOptions ransac;
  int sample_size = 5;               ///< points of an EPnP sample, 4..8
  double inlier_probability = 0.99;  ///< of the chi-square test within RANSAC
  int min_inliers = 15;              ///< fewer are no pose
  double min_inlier_share = 0.15;    ///< of the observations
  PoseRefinementOptions refinement;

  /// Throws std::invalid_argument naming the key.
  void Check() const;
  template <class Visitor>
  void VisitFields(Visitor&& visit) {
    visit("ransac", ransac);
    visit("sample_size", sample_size);
    visit("inlier_probability", inlier_probability);
    visit("min_inliers", min_inliers);
    visit("min_inlier_share", min_inlier_share);
    visit("refinement", refinement);
  }
};

/// The camera's pose from points of the map and where it sees them: EPnP inside RANSAC with the
/// score of MSAC (Torr and Zisserman 2000) on the stereo reprojection errors in units of their
/// standard deviation, promising hypotheses refined (Chum, Matas, Kittler 2003), then RefinePose on
/// the inliers. `predicted_camera_from_world`, as it is and refined, makes two hypotheses more, and
/// nothing else is tried where more than half of the observations agree with the refined one; it
/// is never needed and never trusted.
/// Status kTooFewMatches below min_inliers observations, kNoConsensus where too few agree.
/// `is_inlier`, if not null, becomes [N]: what agrees with the pose; all 0 where there is none.
/// Throws std::invalid_argument for wrong options and for observations that are not IsValid().
PoseEstimate EstimatePose(const StereoCamera& camera,
                          const std::vector<PointObservation>& observations,
                          const std::optional<Rigid3>& predicted_camera_from_world,
                          const PoseEstimatorOptions& options,
                          std::vector<char>* is_inlier = nullptr);

}  // namespace arfm_vo
