#pragma once

#include <optional>

#include "arfm_vo/geometry/rigid3.h"

namespace arfm_vo {

/// Turns the camera's motion through the odometry's world into the base's motion through odom,
///   odom_from_base(t) = odom_from_world * world_from_camera(t) * base_from_camera(t)^-1,
/// where odom_from_world is fixed at a world's first pose, but for Level, so that the base stands
/// where it stood last (REP-105: odom never jumps), at first at the origin with x forward
/// (REP-103).
class BaseMotion {
 public:
  /// odom_from_base of a frame.
  const Rigid3& Move(const Rigid3& camera_from_world, const Rigid3& base_from_camera);

  /// Turns odom, by `max_rad` at most, towards where up, if it is known, is its z axis, about the
  /// base, which stays where it is.
  void Level(const std::optional<Eigen::Vector3d>& up_in_world, double max_rad);
  /// As at first, before a world has begun: at the origin with x forward, but z up.
  void StandBy(const std::optional<Eigen::Vector3d>& up_in_base);

  /// The next frame starts a new world; the base stays where it is.
  void StartEpoch() { has_world_ = false; }
  bool has_world() const { return has_world_; }

  const Rigid3& odom_from_world() const { return odom_from_world_; }  ///< set by Move
  const Rigid3& odom_from_base() const { return odom_from_base_; }    ///< newest

 private:
  bool has_world_ = false;
  Rigid3 odom_from_world_, odom_from_base_;
};

}  // namespace arfm_vo
