#pragma once

#include <deque>
#include <optional>

#include "arfm_vo/odometry/motion_model.h"
#include "arfm_vo/odometry/senses/senses.h"
#include "arfm_vo/pose/pose_estimator.h"

namespace arfm_vo {

/// Where the base may be before a picture tells it: by its senses where they tell how it moved
/// since the last pose that a picture told, else by that motion going on. Poses are
/// base_from_world.
class MotionPrior {
 public:
  explicit MotionPrior(const SensesOptions& options) : senses_(options) {}

  /// What the readings of senses are added to.
  Senses& senses() { return senses_; }

  /// A pose that a picture told, with the covariance of BaseCovariance.
  void Add(double stamp_s, const Rigid3& base_from_world, const Matrix6& covariance);
  /// How the base comes to the next pose is not known.
  void Reset() {
    model_.Reset();
    ForgetPoses();
  }
  /// The poses to come are in another world.
  void StartWorld() {
    model_.StartWorld();
    ForgetPoses();
  }

  /// Up in the poses' world, a unit vector, where an accelerometer tells it.
  const std::optional<Eigen::Vector3d>& up_in_world() const { return up_in_world_; }

  bool KnowsSpeed() const { return model_.KnowsSpeed(); }
  /// The motion since the last pose by the senses, where these tell all of it: tracks, or a gyro
  /// where the base `keeps_speed`.
  std::optional<RelativeMotion> BySenses(double stamp_s, bool keeps_speed) const;
  /// Where a camera on the base may be.
  std::optional<PredictedPose> Predict(double stamp_s, const Rigid3& base_from_camera) const;

 private:
  struct Pose {
    double stamp_s;
    Rigid3 base_from_world;
    Matrix6 covariance;
    std::optional<Eigen::Vector3d> velocity;  ///< m/s, seen from the base
  };
  void ForgetPoses();
  std::optional<RelativeMotion> SinceLast(double stamp_s) const;

  Senses senses_;
  MotionModel model_;
  std::optional<Pose> last_;
  std::deque<Pose> compared_;  ///< those between which the senses are to be learnt next
  std::optional<Eigen::Vector3d> up_in_world_;
};

}  // namespace arfm_vo
