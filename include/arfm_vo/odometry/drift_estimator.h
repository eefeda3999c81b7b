#pragma once

#include <Eigen/Core>
#include <vector>

#include "arfm_vo/bundle_adjustment/pose_information.h"
#include "arfm_vo/geometry/correction_belief.h"
#include "arfm_vo/geometry/rigid3.h"
#include "arfm_vo/mapping/landmark.h"

namespace arfm_vo {

/// How unsure the poses of the window's keyframes are against the first camera of all: what each
/// adjustment of the window leaves open, given the keyframes it holds, on top of what is unsure of
/// those, and what is unknown of the stereo correction, which errs alike in all of them. All
/// covariances are of the steps of BoxPlus(camera_from_world, .), (rad, m).
class DriftEstimator {
 public:
  using Matrix6 = Eigen::Matrix<double, 6, 6>;

  /// A keyframe newer than all known, localised with `covariance` (against the first camera).
  /// It errs with the correction as `beside`, an earlier one (if known), does.
  void Add(KeyframeId keyframe, const Matrix6& covariance, KeyframeId beside = -1,
           const Rigid3& keyframe_from_beside = Rigid3());
  /// Forgets the keyframes older than `oldest`.
  void Forget(KeyframeId oldest);

  /// A window was adjusted: the keyframes of its poses, which of them were held, and the
  /// information on them (FindPoseInformation). All must be known. Nothing changes where the
  /// information does not fix the free poses.
  void Update(const std::vector<KeyframeId>& keyframes, const std::vector<char>& is_held,
              const PoseInformation& information);

  /// What is known of the stereo correction that the poses from now on go by. Errors made with one
  /// that was known less well stay.
  void SetCorrection(const CorrectionBelief& correction);

  /// Covariance of a known keyframe, zero of an unknown one.
  Matrix6 Covariance(KeyframeId keyframe) const;

  void Clear();

 private:
  int Find(KeyframeId keyframe) const;

  std::vector<KeyframeId> keyframes_;  ///< ascending
  Eigen::MatrixXd covariance_;         ///< [6N x 6N], without what the correction errs
  Eigen::MatrixXd by_columns_;         ///< [6N x 10] steps by the columns' coefficients, px^-1
  CorrectionBelief::Columns columns_ = CorrectionBelief::Columns::Zero();
};

/// [6 x 6] the step of BoxPlus(b_from_world, .) by that of a_from_world with b_from_a exact.
Eigen::Matrix<double, 6, 6> CarryStep(const Rigid3& b_from_a);
/// `covariance` of a pose a_from_world as that of b_from_world = b_from_a * a_from_world with
/// b_from_a exact.
Eigen::Matrix<double, 6, 6> CarryCovariance(const Rigid3& b_from_a,
                                            const Eigen::Matrix<double, 6, 6>& covariance);

}  // namespace arfm_vo
