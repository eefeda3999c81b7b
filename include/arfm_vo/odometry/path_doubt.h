#pragma once

#include <optional>

#include "arfm_vo/base/belief.h"
#include "arfm_vo/geometry/rigid3.h"
#include "arfm_vo/odometry/base_covariance.h"
#include "arfm_vo/odometry/motion_model.h"

namespace arfm_vo {

// Prior rates: how long it takes, as a rule.
/// Until something large moves through the image, and until it has left.
constexpr double kAnotherComes_s = 600, kAnotherLeaves_s = 2;

/// Whether the poses of late are those of what moves on its own. Then the camera has gone on as it
/// did before, and is where that leads: further from its pose with each pair, by one error.
class PathDoubt {
 public:
  /// From this probability on it is worth telling.
  static constexpr double kLikely = 0.1;

  /// A pose, camera from world, that is the ground's with these odds, later than the one before.
  /// `predicted`: by the motion before; nothing where that is not known.
  void Follow(double stamp_s, const Rigid3& pose, const std::optional<Rigid3>& predicted,
              double log_odds);
  double Probability() const { return 1 - ground_.Probability(); }
  bool IsLikely() const { return Probability() > kLikely; }
  /// How far the camera's place may be wrong (m^2, axes of the world).
  Eigen::Matrix3d Covariance() const { return closed_ + Probability() * Squared(); }

 private:
  /// Time passes: the poses may be the ground's again, and begin where those before led.
  void Advance(double interval_s);
  Eigen::Matrix3d Squared() const { return displacement_ * displacement_.transpose(); }

  struct StampedPose {
    double stamp_s;
    Rigid3 camera_from_world;
  };

  Belief ground_{0.99};
  std::optional<StampedPose> last_;
  MotionModel before_;  ///< the motion before the doubt, or the first that is known
  Eigen::Vector3d displacement_ = Eigen::Vector3d::Zero();  ///< to where that leads
  Eigen::Matrix3d closed_ = Eigen::Matrix3d::Zero();        ///< of doubts that are over
};

/// A map begun after a loss may have begun on what moves: on the object that hid the ground. A base
/// that goes on in it as it went before has the ground in view; what has changed its motion within
/// the loss may be the base or what it looks at.
class NewMapDoubt {
 public:
  /// A map begins at `odom_from_base`; the base had `twist_before` (m/s, rad/s).
  NewMapDoubt(double stamp_s, const Rigid3& odom_from_base, const Twist& twist_before);

  /// Takes a pose in the new map. Returns whether the base moves otherwise than before.
  bool Follow(double stamp_s, const Rigid3& odom_from_base);
  /// Whether nothing more can be told.
  bool IsOver() const { return is_over_; }
  /// Where the map began.
  const Rigid3& odom_from_start() const { return odom_from_start_; }

 private:
  double stamp_s_;
  Rigid3 odom_from_start_;
  Twist twist_before_;
  bool is_over_ = false;
};

}  // namespace arfm_vo
