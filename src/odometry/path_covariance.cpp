#include "arfm_vo/odometry/path_covariance.h"

namespace arfm_vo {

void PathCovariance::Begin(const Rigid3& camera_from_world, const Matrix6& covariance) {
  newest_ = PoseDrift{covariance};
  newest_rotation_ = camera_from_world.RotationMatrix();
  way_ = {};
  FollowWay(camera_from_world, true);
}

void PathCovariance::AddPose(const Keyframe& newest, const Rigid3& camera_from_world,
                             const PoseDrift& own) {
  newest_ = drift_.Beside(newest.id, camera_from_world * newest.camera_from_world.Inverse(), own);
  newest_rotation_ = camera_from_world.RotationMatrix();
}

void PathCovariance::AddKeyframe(KeyframeId keyframe, KeyframeId oldest) {
  drift_.Add(keyframe, newest_);
  drift_.Forget(oldest);
}

void PathCovariance::Clear() {
  drift_.Clear();
  way_ = {};
}

PathCovariance::Matrix6 PathCovariance::WithWay(Matrix6 covariance,
                                                const Eigen::Matrix3d& camera_from_world) const {
  covariance.bottomRightCorner<3, 3>() +=
      camera_from_world * way_.Covariance() * camera_from_world.transpose();
  return covariance;
}

}  // namespace arfm_vo
