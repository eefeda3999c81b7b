#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "arfm_vo/geometry/correction_belief.h"
#include "arfm_vo/geometry/rigid3.h"
#include "arfm_vo/geometry/stereo_camera.h"
#include "arfm_vo/reconstruction/stereo_observation.h"

namespace arfm_vo {

/// Where a pose saw a point.
struct BundleObservation : StereoObservation {
  int pose = 0, point = 0;  ///< indices into the problem
};
static_assert(sizeof(BundleObservation) == 32);

/// What is known of the motion between two poses without points, such as a closed loop:
/// second_from_first = BoxPlus(measured, e) with e of zero mean and covariance `information`^-1.
struct PoseConstraint {
  int first = 0, second = 0;  ///< indices into the problem
  Rigid3 second_from_first;
  Eigen::Matrix<double, 6, 6> information;  ///< (rad, m)^-2; symmetric, positive semi-definite
};

/// Poses, points and what the poses saw, to be brought into agreement.
struct BundleProblem {
  StereoCamera camera;
  std::vector<Rigid3> camera_from_world;
  std::vector<char> pose_is_fixed;      ///< [poses]; at least one must be: the gauge
  std::vector<Eigen::Vector3d> points;  ///< m, world frame
  std::vector<BundleObservation> observations;
  std::vector<PoseConstraint> constraints;

  StereoCorrection correction;  ///< where to start
  /// What is known of the correction without these observations; nothing: it stays where it starts.
  std::optional<CorrectionBelief> correction_prior;
  /// Where the prior holds all else, the only ways in which the correction may move: less to solve.
  std::optional<CorrectionBelief::Turns> correction_turns;

  /// Throws std::invalid_argument naming what is wrong: sizes that differ, an index out of range,
  /// a value that is not finite, a sigma that is not positive, no observation or no fixed pose.
  void Check() const;
};

}  // namespace arfm_vo
