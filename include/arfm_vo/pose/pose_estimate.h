#pragma once

#include <Eigen/Core>
#include <optional>

#include "arfm_vo/geometry/rigid3.h"

namespace arfm_vo {

/// Why a frame has a pose or has none.
enum class PoseStatus {
  kTracked,         ///< pose found
  kTooFewFeatures,  ///< too few keypoints or stereo points in the pair
  kTooFewMatches,   ///< too few of the map's points were found again
  kNoConsensus,     ///< matches, but no motion that enough of them agree with
  kNoTransform,     ///< not tried: where the camera sat on the rover is not known
  kHeadSlewing,     ///< not tried: the head turned faster than the limit
  kDegraded,        ///< a pose to be wary of: its covariance says how wrong it may be
};

/// The name of a status as messages and files show it, such as "too few matches".
const char* ToString(PoseStatus status);

struct PoseRefinement;

/// The pose of one frame. Where HasPose() is false, pose and covariance hold nothing.
struct PoseEstimate {
  PoseStatus status = PoseStatus::kTooFewFeatures;
  Rigid3 camera_from_world;
  /// Covariance of the tangent step of BoxPlus(camera_from_world, .): (rotation rad, translation
  /// m), camera frame.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  int num_matches = 0;
  int num_inliers = 0;
  std::optional<Rigid3> rival;  ///< another pose, on which points that contradict this one agree
  double votes = 0;             ///< for the pose, against another one of the same frame
  double rms_px = 0;            ///< root mean square of the inliers' reprojection errors

  /// Sets pose, covariance, num_inliers and rms_px.
  void Set(const PoseRefinement& refined);
  bool IsTracked() const { return status == PoseStatus::kTracked; }
  bool HasPose() const { return IsTracked() || status == PoseStatus::kDegraded; }
  /// Whether the picture told the pose, not the motion before alone.
  bool IsMeasured() const { return HasPose() && num_inliers > 0; }
};

}  // namespace arfm_vo
