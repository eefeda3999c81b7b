#pragma once

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
  bool KnowsSpeed() const { return last_ && last_->body_from_before; }
  void Reset() { last_.reset(); }

 private:
  struct Motion {
    double stamp_s = 0;
    Rigid3 body_from_world;
    std::optional<Rigid3> body_from_before;
    double interval_s = 0;
  };
  std::optional<Motion> last_;
};

}  // namespace arfm_vo
