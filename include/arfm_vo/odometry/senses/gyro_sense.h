#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "arfm_vo/odometry/senses/sense_readings.h"
#include "arfm_vo/odometry/senses/sense_state.h"

namespace arfm_vo {

/// How a base turned between two times.
struct Turn {
  Eigen::Quaterniond before_from_now;
  Eigen::Matrix3d covariance;  ///< rad^2, seen from the base now
};

/// A gyro on the base. What is learnt of it: its bias, the matrix between the rate and what it
/// reads (scale, sign, a wrong mount), and how late its stamps are,
///   rate(t) = matrix (reading(t + delay) - bias).
class GyroSense {
 public:
  GyroSense();

  /// Takes a reading, rad/s, seen from the base.
  void Add(double stamp_s, const Eigen::Vector3d& rate_rad_s) {
    readings_.Add(stamp_s, rate_rad_s);
  }
  /// Nothing where the readings do not reach so far.
  std::optional<Turn> TurnBetween(double from_s, double to_s) const;
  /// Its rotation alone, of times for which there is one.
  Eigen::Quaterniond RotationBetween(double from_s, double to_s) const {
    return Integrate(from_s, to_s).before_from_now;
  }
  /// What the cameras say of a turn, with the covariance of Turn.
  void Learn(double from_s, double to_s, const Turn& by_cameras);

  const SenseState& state() const { return state_; }

 private:
  using Jacobian = Eigen::Matrix<double, 3, 13>;
  struct Integral {
    Eigen::Quaterniond before_from_now = Eigen::Quaterniond::Identity();
    Jacobian jacobian = Jacobian::Zero();  ///< of its step, seen from the base now, by the numbers
  };
  bool Cover(double from_s, double to_s) const;
  Integral Integrate(double from_s, double to_s) const;

  SenseReadings<Eigen::Vector3d> readings_;
  SenseState state_;
};

}  // namespace arfm_vo
