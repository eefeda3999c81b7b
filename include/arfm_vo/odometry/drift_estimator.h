#pragma once

#include <Eigen/Core>
#include <map>
#include <vector>

#include "arfm_vo/bundle_adjustment/pose_information.h"
#include "arfm_vo/geometry/correction_belief.h"
#include "arfm_vo/geometry/linear_algebra.h"
#include "arfm_vo/geometry/rigid3.h"
#include "arfm_vo/mapping/landmark.h"
#include "arfm_vo/pose/carry_covariance.h"

namespace arfm_vo {

/// How unsure a pose is against the first camera of all, in the steps of BoxPlus(camera_from_world,
/// .), (rad, m): noise, and how it errs with what is unknown of the stereo correction, which is the
/// same for all poses.
struct PoseDrift {
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();  ///< by noise
  /// Step by the coefficients that move points, px^-1.
  Eigen::Matrix<double, 6, StereoCorrection::kNumPlacing> by_correction =
      Eigen::Matrix<double, 6, StereoCorrection::kNumPlacing>::Zero();
};

/// How unsure the poses of the window's keyframes are against the first camera of all: what each
/// adjustment of the window leaves open, given the keyframes it holds, on top of what is unsure of
/// those, and what is unknown of the stereo correction, which errs alike in all of them. All
/// covariances are of the steps of BoxPlus(camera_from_world, .), (rad, m).
class DriftEstimator {
 public:
  using Matrix6 = Eigen::Matrix<double, 6, 6>;

  /// A keyframe newer than all known.
  void Add(KeyframeId keyframe, const PoseDrift& drift);
  /// Forgets the keyframes older than `oldest`.
  void Forget(KeyframeId oldest);

  /// A window was adjusted: the keyframes of its poses, which of them were held, and the
  /// information on them (FindPoseInformation). All must be known. Nothing changes where the
  /// information does not fix the free poses.
  void Update(const std::vector<KeyframeId>& keyframes, const std::vector<char>& is_held,
              const PoseInformation& information);

  /// What is known of the stereo correction that the poses from now on go by. Errors made with one
  /// that was known less well stay: those of each keyframe, but of one that an adjustment has moved
  /// to `moved` (keyframe_from_anchor) against another, the anchor, those of that one.
  void SetCorrection(const CorrectionBelief& correction, KeyframeId anchor = 0,
                     const std::map<KeyframeId, Rigid3>& moved = {});

  /// Covariance of a known keyframe, zero of an unknown one.
  Matrix6 Covariance(KeyframeId keyframe) const { return Covariance(Drift(keyframe)); }
  /// Covariance of a pose, all told.
  Matrix6 Covariance(const PoseDrift& drift) const {
    return drift.covariance + Propagate(drift.by_correction, unknown_);
  }
  /// Of a pose beside a keyframe (no drift where that is unknown); `own` is its drift against it.
  PoseDrift Beside(KeyframeId keyframe, const Rigid3& pose_from_keyframe,
                   const PoseDrift& own) const;
  void Clear();

 private:
  PoseDrift Drift(KeyframeId keyframe) const;
  int Find(KeyframeId keyframe) const;

  std::vector<KeyframeId> keyframes_;  ///< ascending
  Eigen::MatrixXd covariance_;         ///< [6N x 6N], without what the correction errs
  /// [6N x kNumPlacing] steps by the coefficients that move points, px^-1
  Eigen::MatrixXd by_correction_ = Eigen::MatrixXd(0, StereoCorrection::kNumPlacing);
  /// Covariance of these coefficients, px^2.
  Eigen::MatrixXd unknown_ =
      Eigen::MatrixXd::Zero(StereoCorrection::kNumPlacing, StereoCorrection::kNumPlacing);
};

}  // namespace arfm_vo
