#pragma once

#include <Eigen/Core>

#include "arfm_vo/mapping/keyframe.h"
#include "arfm_vo/odometry/drift_estimator.h"
#include "arfm_vo/odometry/local_bundle.h"
#include "arfm_vo/odometry/odometry_update.h"
#include "arfm_vo/odometry/path_doubt.h"

namespace arfm_vo {

/// The way on which the depths were not known: how long it was may be wrong by all of it.
class UnknownWay {
 public:
  /// `centre` of the camera, in the world.
  void Follow(const Eigen::Vector3d& centre, bool are_depths_known) {
    if (are_depths_known) {
      closed_ = Covariance();
      start_ = centre;
    }
    newest_ = centre;
  }
  /// Where the camera is may be wrong by this besides (m^2, axes of the world).
  void AddDoubt(const Eigen::Matrix3d& covariance) { closed_ += covariance; }
  /// Of the place, m^2, axes of the world.
  Eigen::Matrix3d Covariance() const {
    return closed_ + (newest_ - start_) * (newest_ - start_).transpose();
  }

 private:
  Eigen::Vector3d start_ = Eigen::Vector3d::Zero();  ///< where they were known last
  Eigen::Vector3d newest_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d closed_ = Eigen::Matrix3d::Zero();  ///< up to start_
};

/// The drift of a pose against the newest keyframe: its own covariance, and what the correction
/// does by the points that both see, some 100 of them: zero where these do not fix the pose.
PoseDrift FindDrift(const StereoCamera& camera, const StereoCorrection& correction,
                    const LocalMap& map, const OdometryUpdate& update, const BundleOptions& solver);

/// How unsure the newest pose and the map's keyframes are against the first camera of all: what
/// drifts from keyframe to keyframe, and the ways whose length was not known. All covariances are
/// of the steps of BoxPlus(camera_from_world, .), (rad, m).
class PathCovariance {
 public:
  using Matrix6 = DriftEstimator::Matrix6;

  /// As DriftEstimator::SetCorrection; unless null, an adjustment has moved the keyframes of `map`
  /// against the newest one that it knew, `anchor`.
  void SetCorrection(const CorrectionBelief& correction, const LocalMap& map,
                     const Keyframe* anchor);

  /// The newest pose is not told by those before it: the first of a map, or one recognised.
  void Begin(const Rigid3& camera_from_world, const Matrix6& covariance);
  /// The way to a pose that is about to be added.
  void FollowWay(const Rigid3& camera_from_world, bool are_depths_known) {
    way_.Follow(camera_from_world.Inverse().translation, are_depths_known);
  }
  /// See PathDoubt::Follow.
  void FollowDoubt(double stamp_s, const Rigid3& camera_from_world,
                   const std::optional<Rigid3>& predicted, double log_odds) {
    doubt_.Follow(stamp_s, camera_from_world, predicted, log_odds);
  }
  void AddDoubtOfWay(double sigma_m) {
    way_.AddDoubt(sigma_m * sigma_m * Eigen::Matrix3d::Identity());
  }
  /// The newest pose; `own` is its drift against `newest`, the newest keyframe.
  void AddPose(const Keyframe& newest, const Rigid3& camera_from_world, const PoseDrift& own);
  /// The newest pose has become a keyframe; it, and all that follows, may stand where a step of
  /// this covariance leads. Keyframes older than `oldest` have left the map.
  void AddKeyframe(KeyframeId keyframe, KeyframeId oldest, const Matrix6& doubt = Matrix6::Zero());
  /// A keyframe that is adjusted no more, the one after the last such one, or the same.
  void Settle(const Keyframe& keyframe);
  /// By how much less sure it is than the one before, carried to it: what a step of the drive adds.
  const Matrix6& step_covariance() const { return step_covariance_; }
  /// The newest keyframes were adjusted.
  void Update(const LocalBundle& window, const PoseInformation& information) {
    drift_.Update(window.keyframes, window.problem.pose_is_fixed, information);
  }
  void Clear();

  Matrix6 OfNewest() const { return WithWay(drift_.Covariance(newest_), newest_rotation_); }
  Matrix6 OfKeyframe(const Keyframe& keyframe) const {
    return WithWay(drift_.Covariance(keyframe.id), keyframe.camera_from_world.RotationMatrix());
  }

 private:
  Matrix6 WithWay(Matrix6 covariance, const Eigen::Matrix3d& camera_from_world) const;

  DriftEstimator drift_;
  PoseDrift newest_;
  Eigen::Matrix3d newest_rotation_ = Eigen::Matrix3d::Identity();  ///< camera_from_world
  UnknownWay way_;
  PathDoubt doubt_;
  Rigid3 settled_from_world_;
  Matrix6 settled_covariance_ = Matrix6::Zero(), step_covariance_ = Matrix6::Zero();
};

}  // namespace arfm_vo
