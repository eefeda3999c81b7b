#pragma once

#include <cmath>
#include <optional>

#include "arfm_vo/geometry/rigid3.h"

namespace arfm_vo {

/// Where a body will be if it goes on as between its last two poses. Poses are body_from_world.
class MotionModel {
 public:
  /// A pose, later than the one before.
  void Add(double stamp_s, const Rigid3& body_from_world);
  /// The last pose where there is but one; nothing without any.
  std::optional<Rigid3> Predict(double stamp_s) const;
  bool KnowsSpeed() const { return last_ && last_->body_from_before && !is_new_world_; }
  /// Times the acceleration: how far the body may be from Predict, where it KnowsSpeed, s^2.
  double ChangeTime(double stamp_s) const;
  /// Accelerations of late, root mean square: m/s^2 and rad/s^2.
  double usual_acceleration_m_s2() const { return std::sqrt(squared_m_); }
  double usual_turn_acceleration_rad_s2() const { return std::sqrt(squared_rad_); }
  /// The poses to come are in another world; the speed is the same, unless it has changed
  /// meanwhile.
  void StartWorld() {
    is_new_world_ = true;
    squared_m_ = kSquared_m;
    squared_rad_ = kSquared_rad;
  }
  void Reset() { *this = MotionModel(); }

 private:
  void Learn(double stamp_s, const Rigid3& body_from_world);

  struct Motion {
    double stamp_s = 0;
    Rigid3 body_from_world;
    std::optional<Rigid3> body_from_before;
    double interval_s = 0;
    double speed_stamp_s = 0;  ///< when body_from_before was measured
  };
  std::optional<Motion> last_;
  /// Before anything is known: what a vehicle or a hand can do.
  static constexpr double kSquared_m = 25, kSquared_rad = 25;
  double squared_m_ = kSquared_m, squared_rad_ = kSquared_rad;
  bool is_new_world_ = false;
};

}  // namespace arfm_vo
