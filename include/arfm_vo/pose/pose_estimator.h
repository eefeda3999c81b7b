#pragma once

#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "arfm_vo/base/fields.h"
#include "arfm_vo/base/ransac.h"
#include "arfm_vo/pose/pose_estimate.h"
#include "arfm_vo/pose/pose_refinement.h"

namespace arfm_vo {

constexpr int kSamplePoints = 3;  ///< of P3P

struct PoseEstimatorOptions {
  RansacOptions ransac;
  int min_inliers = kSamplePoints + 2;  ///< fewer are no pose, nor as many as agree by chance
  double min_inlier_share = 0.15;       ///< of the observations' votes
  PoseRefinementOptions refinement;

  /// The same, which looks for another pose also beside one with a majority.
  PoseEstimatorOptions Wary() const {
    PoseEstimatorOptions wary = *this;
    wary.is_wary = true;
    return wary;
  }
  bool is_wary = false;

  /// Throws std::invalid_argument naming the key.
  void Check() const;
  ARFM_FIELDS(ransac, min_inlier_share, refinement)
};

/// Where the camera may be by its motion before.
struct PredictedPose {
  Rigid3 camera_from_world;
  /// How far it can be from there at most: the centre, m, and the axes, rad.
  double max_shift_m = std::numeric_limits<double>::infinity();
  double max_turn_rad = std::numeric_limits<double>::infinity();
  /// How far it is as a rule.
  double sigma_shift_m = std::numeric_limits<double>::infinity();
  double sigma_turn_rad = std::numeric_limits<double>::infinity();
  /// How far the centre may have gone from there, along each axis, whatever has happened since a
  /// picture told last: standard deviation, m.
  double gap_sigma_m = std::numeric_limits<double>::infinity();

  PredictedPose(const Rigid3& camera_from_world) : camera_from_world(camera_from_world) {}
  bool IsSpeedKnown() const { return std::isfinite(sigma_shift_m); }
  bool Allows(const Rigid3& other_camera_from_world) const {
    const Rigid3 between = other_camera_from_world * camera_from_world.Inverse();
    return between.translation.norm() <= max_shift_m && between.Angle() <= max_turn_rad;
  }
  /// Whether the centre may have come to that of `other` (three axes: with 99.9 %).
  bool IsWithinGap(const Rigid3& other_camera_from_world) const {
    const Rigid3 between = other_camera_from_world * camera_from_world.Inverse();
    return between.translation.norm() <= 4 * gap_sigma_m;
  }
  /// How much likelier `other` is by the motion before than an unusual change of it, in logarithms;
  /// 0 where that motion is not known.
  double LogOdds(const Rigid3& other_camera_from_world) const;
};

constexpr char kAgreesWithRival = 2;

/// The camera's pose from points of the map and where it sees them: EPnP on those that agree,
/// found by RANSAC with samples of three (P3P) and the score of MSAC (Torr and Zisserman 2000) on
/// the stereo reprojection errors in units of their standard deviation, promising hypotheses
/// refined (Chum, Matas, Kittler 2003), then RefinePose on the inliers. Where more than half of the
/// votes are for the refined prediction nothing else is tried; a pose that the prediction does not
/// allow needs four times the votes. The prediction is never needed. Where many points that
/// contradict the pose agree with one another there is a rival. Status kTooFewMatches below
/// min_inliers observations, kNoConsensus where too few agree. `is_inlier`, if not null, becomes
/// [N]: 1 where an observation agrees with the pose, kAgreesWithRival where it agrees with the
/// rival alone; all 0 where there is none. Throws std::invalid_argument for wrong options and for
/// observations that are not IsValid().
PoseEstimate EstimatePose(const StereoCamera& camera,
                          const std::vector<PointObservation>& observations,
                          const std::optional<PredictedPose>& predicted,
                          const PoseEstimatorOptions& options,
                          std::vector<char>* is_inlier = nullptr);

}  // namespace arfm_vo
