#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>

#include "arfm_vo/odometry/senses/gyro_sense.h"
#include "arfm_vo/odometry/senses/sense_readings.h"
#include "arfm_vo/odometry/senses/sense_state.h"

namespace arfm_vo {

/// The accelerometer of an IMU on the base: it tells which way is up. Carried from time to time by
/// the turn that the cameras saw, and corrected by the mean of the readings, of which what the base
/// accelerates by is noise, as large as they spread. Learnt of it: what it reads where the base is
/// level, and how this changes where it leans,
///   reading = level + g (matrix (u_x, u_y) + z (u_z - 1)),   u: up, seen from the base.
class GravitySense {
 public:
  GravitySense();

  /// Takes a reading, the specific force (m/s^2, up at rest), seen from the base.
  void Add(double stamp_s, const Eigen::Vector3d& force_m_s2) {
    readings_.Add(stamp_s, force_m_s2);
  }
  /// By the readings of the second before a first pose.
  void Begin(double stamp_s);
  /// The base turned as the cameras say, and went by `change_m_s` faster at the end, seen from
  /// there.
  void Learn(double from_s, double to_s, const Turn& by_cameras, const Eigen::Vector3d& change_m_s);
  /// How the base turned since is not known.
  void Forget();

  /// Up at the last time, a unit vector seen from the base, as far as readings have told it and the
  /// sense is right.
  std::optional<Eigen::Vector3d> up_in_base() const;
  /// As any sense would be, right or wrong.
  const SenseState& state() const { return any_.state; }

 private:
  /// What readings tell, by what is known of the sense before.
  struct Belief {
    SenseState state;  ///< its first numbers are the step ExpSO3(.) of up
    Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
    void Carry(const Turn& turn);
    void Update(const Eigen::Vector3d& force_m_s2, const Eigen::Vector3d& variance);
  };
  void Update(double from_s, double to_s, const Eigen::Vector3d& turn_rad,
              const Eigen::Vector3d& change_m_s);

  SenseReadings<Eigen::Vector3d> readings_;
  Belief any_, right_;
  bool is_told_ = false;
};

}  // namespace arfm_vo
