#pragma once

#include <optional>
#include <string>

#include "arfm_vo/base/check.h"
#include "arfm_vo/base/fields.h"
#include "arfm_vo/odometry/base_covariance.h"
#include "arfm_vo/odometry/senses/gravity_sense.h"
#include "arfm_vo/odometry/senses/gyro_sense.h"
#include "arfm_vo/odometry/senses/track_sense.h"

namespace arfm_vo {

struct SensesOptions {
  bool use_tracks = false;  ///< odometry of wheels or tracks
  bool use_imu = false;     ///< its gyro, and its accelerometer where it has one
  double max_blind_m = 2;   ///< way on which the tracks carry the pose where no picture tells it

  void Check() const { Require(max_blind_m >= 0, "senses.max_blind_m must not be negative"); }
  ARFM_FIELDS(use_tracks, use_imu, max_blind_m)
};

/// How a base moved between two times.
struct RelativeMotion {
  Rigid3 before_from_now;
  Matrix6 covariance = Matrix6::Zero();  ///< as BaseCovariance has it, of the base now
  double way_m = 0;                      ///< the length of its way
  bool is_way_measured = false;          ///< by the tracks, not taken from the speed before
  const char* by = "";                   ///< which senses told it
};

/// What tells the base's motion besides the cameras: tracks the way, a gyro the turn, or the tracks
/// that too, an accelerometer which way is up. Each is learnt against the cameras, and left out
/// while it contradicts them.
class Senses {
 public:
  explicit Senses(const SensesOptions& options) : options_(options) { options.Check(); }

  GyroSense& gyro() { return gyro_; }
  GravitySense& gravity() { return gravity_; }
  TrackSense& tracks() { return tracks_; }
  const GyroSense& gyro() const { return gyro_; }
  const GravitySense& gravity() const { return gravity_; }
  const TrackSense& tracks() const { return tracks_; }
  const SensesOptions& options() const { return options_; }

  /// Nothing where no sense that is right tells it. Without tracks the way is that of a base that
  /// goes on with `velocity_m_s`, seen from itself, unknown to `speed_sigma_m_s`.
  std::optional<RelativeMotion> Between(double from_s, double to_s,
                                        const Eigen::Vector3d& velocity_m_s,
                                        double speed_sigma_m_s) const;
  /// What the cameras say of a motion, with its covariance, and by how much the base was faster at
  /// its end, seen from there.
  void Learn(double from_s, double to_s, const RelativeMotion& by_cameras,
             const Eigen::Vector3d& change_m_s);
  /// Up at a first pose, a unit vector seen from the base; nothing where no reading tells it.
  std::optional<Eigen::Vector3d> FirstUp(double stamp_s);

  /// As GravitySense has it, where it is used.
  std::optional<Eigen::Vector3d> up_in_base() const {
    return options_.use_imu ? gravity_.up_in_base() : std::nullopt;
  }

  /// Which are left out and why, in words; empty where none is.
  std::string FindFaults() const;

 private:
  SensesOptions options_;
  GyroSense gyro_;
  GravitySense gravity_;
  TrackSense tracks_;
};

}  // namespace arfm_vo
