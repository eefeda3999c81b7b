#pragma once

#include "arfm_vo/mapping/local_map.h"
#include "arfm_vo/odometry/frame_tracker.h"

namespace arfm_vo {

/// Whether both eyes tell the depth of half of the points well enough to tell how long the way is.
/// Where they do not the pose looks certain all the same: looming tells the way in proportion to
/// the depths, and the errors of these are no longer small, nor independent.
bool AreDepthsKnown(const StereoCamera& camera, const LocalMap& map, const TrackedFrame& tracked);

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
  /// Where the camera is may be wrong by this besides, in any direction.
  void AddDoubt(double sigma_m) { closed_ += sigma_m * sigma_m * Eigen::Matrix3d::Identity(); }
  /// Of the place, m^2, axes of the world.
  Eigen::Matrix3d Covariance() const {
    return closed_ + (newest_ - start_) * (newest_ - start_).transpose();
  }

 private:
  Eigen::Vector3d start_ = Eigen::Vector3d::Zero();  ///< where they were known last
  Eigen::Vector3d newest_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d closed_ = Eigen::Matrix3d::Zero();  ///< up to start_
};

}  // namespace arfm_vo
