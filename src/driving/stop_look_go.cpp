#include "arfm_vo/driving/stop_look_go.h"

#include <algorithm>
#include <cmath>

#include "arfm_vo/base/range_check.h"

namespace arfm_vo {

void StopLookGoOptions::Check() const {
  RequireInRange(step_m, 0.02, 10, "stop_look_go.step_m");
  RequireAbove(max_pose_age_s, 0, 3600, "stop_look_go.max_pose_age_s");
}

PlanarMotion StopLookGo::Gate(const PlanarMotion& wanted, const TrackWays& ways, bool is_at_rest) {
  if (!options_.is_on || wanted.IsZero()) return wanted;
  if (is_looking_) {
    if (!is_at_rest) return {};
    step_start_ = ways;
  }
  const double way_m = std::max(std::abs(ways.left_m - step_start_.left_m),
                                std::abs(ways.right_m - step_start_.right_m));
  is_looking_ = way_m >= options_.step_m;
  return is_looking_ ? PlanarMotion{} : wanted;
}

}  // namespace arfm_vo
