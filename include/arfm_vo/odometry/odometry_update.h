#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "arfm_vo/mapping/landmark.h"
#include "arfm_vo/odometry/reason.h"
#include "arfm_vo/odometry/stereo_skew.h"
#include "arfm_vo/pose/pose_estimate.h"

namespace arfm_vo {

/// Wall time of each stage in ms, in their order.
using StageTimes = std::vector<std::pair<std::string, double>>;

/// What one pair brought.
struct OdometryUpdate {
  double stamp_s = 0;
  PoseEstimate pose;              ///< as known at once, before any later correction
  Reason reason = Reason::kNone;  ///< why there is no pose, or one to be wary of
  /// Of the step to where the camera is if the pose is not the ground's: part of pose.covariance,
  /// which may be wrong as a whole, once and for all that follows.
  Eigen::Matrix<double, 6, 6> doubt = Eigen::Matrix<double, 6, 6>::Zero();
  double log_odds = 0;  ///< that the pose is the ground's and not that of what moves on its own
  /// As pose.covariance, but against the first camera of all: what the map has drifted added.
  Eigen::Matrix<double, 6, 6> covariance_from_start = Eigen::Matrix<double, 6, 6>::Zero();
  bool can_start = false;  ///< whether a map could begin with the pair
  bool is_keyframe = false;
  bool is_relocalised = false;        ///< found among keyframes that had left the local map
  LandmarkObservations observations;  ///< of the map's landmarks that agree with the pose
  std::optional<StereoSkew> skew;     ///< where the right picture is late or early, and made up for
  double median_row_residual_px = 0;  ///< v_right - v_left of the stereo points: calibration health
  StageTimes stage_ms;
  /// What the motion is told by where no picture measured it.
  const char* goes_on_by = "the last motion is continued";

  /// Its status in words, and why.
  std::string Describe() const;
  /// The pose is not quite good, for this reason.
  void Degrade(Reason why) {
    pose.status = PoseStatus::kDegraded;
    reason = why;
  }
};

}  // namespace arfm_vo
