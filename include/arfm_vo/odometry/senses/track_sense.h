#pragma once

#include <optional>
#include <vector>

#include "arfm_vo/odometry/senses/sense_readings.h"
#include "arfm_vo/odometry/senses/sense_state.h"

namespace arfm_vo {

/// A piece of the way by the tracks, with what is learnt of them made up for.
struct TrackStep {
  double from_s, to_s;
  Rigid3 before_from_now;
};

/// Odometry of wheels or tracks. What is learnt of it: how much longer it tells ways ahead and
/// turns than they are (slip).
class TrackSense {
 public:
  TrackSense();

  /// Takes the base's pose in the tracks' own frame. A leap begins anew: the odometry was
  /// restarted.
  void Add(double stamp_s, const Rigid3& odom_from_base);
  /// Nothing where the readings do not reach so far.
  std::optional<std::vector<TrackStep>> StepsBetween(double from_s, double to_s) const;
  /// Variance of the length of a way, m^2, and of the turn on it, rad^2.
  double WayVariance(double way_m) const;
  double TurnVariance(double turn_rad, double way_m) const;
  /// What the cameras say of a motion, and the variances of its length and its turn, m^2, rad^2.
  void Learn(double from_s, double to_s, const Rigid3& before_from_now, double variance_m2,
             double variance_rad2);

  const SenseState& state() const { return state_; }

 private:
  SenseReadings<Rigid3> readings_;
  SenseState state_;
};

}  // namespace arfm_vo
