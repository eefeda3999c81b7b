#pragma once

#include <optional>

#include "arfm_vo/geometry/rigid3.h"

namespace arfm_vo {

/// Where a camera will be if it goes on as between its last two poses.
class MotionModel {
 public:
  /// A pose, later than the one before.
  void Add(double stamp_s, const Rigid3& camera_from_world);
  /// The last pose where there is but one; nothing without any.
  std::optional<Rigid3> Predict(double stamp_s) const;
  void Reset() { last_.reset(); }

 private:
  struct Motion {
    double stamp_s = 0;
    Rigid3 camera_from_world;
    std::optional<Rigid3> camera_from_before;
    double interval_s = 0;
  };
  std::optional<Motion> last_;
};

}  // namespace arfm_vo
