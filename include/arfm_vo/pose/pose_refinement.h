#pragma once

#include <Eigen/Core>
#include <vector>

#include "arfm_vo/base/fields.h"
#include "arfm_vo/geometry/rigid3.h"
#include "arfm_vo/geometry/stereo_camera.h"
#include "arfm_vo/pose/point_observation.h"
#include "arfm_vo/pose/robust_loss.h"

namespace arfm_vo {

/// Of the chi-square test that tells inliers, at the measured scale.
constexpr double kInlierProbability = 0.99;

/// Whether a step that raises the cost is shortened (Levenberg-Marquardt) or ends the search.
enum class StepKind { kGaussNewton, kLevenbergMarquardt };

inline std::vector<std::pair<std::string, StepKind>> ListNames(StepKind) {
  return {{"gauss_newton", StepKind::kGaussNewton},
          {"levenberg_marquardt", StepKind::kLevenbergMarquardt}};
}

struct PoseRefinementOptions {
  StepKind step = StepKind::kLevenbergMarquardt;  ///< of the iteration
  int max_rounds = 4;                 ///< a round measures scale and inliers anew, then iterates
  LossKind loss = LossKind::kCauchy;  ///< robust loss of the residuals
  double loss_threshold_sigma = 2.4;  ///< of a residual of one coordinate, in measured scale;
                                      ///< customary: Huber 1.3, Cauchy 2.4, Tukey 4.7

  void Check() const;
  ARFM_FIELDS(step, loss)
};

enum class RefinementStatus {
  kConverged,
  kTooFewPoints,   ///< fewer than 4 agree with the pose
  kRankDeficient,  ///< the points do not fix all six directions
};

struct PoseRefinement {
  RefinementStatus status = RefinementStatus::kTooFewPoints;
  Rigid3 camera_from_world;
  /// Of the step of BoxPlus(camera_from_world, .): (rad, m), camera frame; zero unless kConverged.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  std::vector<char> is_inlier;  ///< [N]
  int num_inliers = 0;
  int num_iterations = 0;
  double scale = 1;   ///< measured size of the residuals in stated standard deviations
  double rms_px = 0;  ///< of the inliers' reprojection errors, a coordinate
};

/// The pose that minimises the robust reprojection error
///   sum_i rho(r_i^T S_i^-1 r_i / scale^2),  r_i = (u_left, v, u_right)_i - ProjectStereo(R x_i +
///   t)
/// with S_i = sigma_i^2 I + J_i P_i J_i^T, P_i the covariance of the point and J_i the derivative
/// of its projection; (u, v) alone where the right image does not see the point. `scale` is
/// measured from the residuals (median), and observations beyond the chi-square bound are left out.
/// The covariance is that of an M-estimator (Huber, Robust Statistics, 1981, 7.6).
/// `is_inlier` [N]: what to start with; empty = what is proven, or all where that is too few.
/// Observations must be IsValid().
PoseRefinement RefinePose(const StereoCamera& camera,
                          const std::vector<PointObservation>& observations,
                          const Rigid3& camera_from_world, const PoseRefinementOptions& options,
                          const std::vector<char>& is_inlier = {});

}  // namespace arfm_vo
