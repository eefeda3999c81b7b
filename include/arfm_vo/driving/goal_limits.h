#pragma once

#include <string>
#include <vector>

#include "arfm_vo/base/fields.h"
#include "arfm_vo/driving/route.h"

namespace arfm_vo {

struct GoalLimitsOptions {
  double max_distance_m = 50;  ///< of each waypoint from the rover
  int max_waypoints = 100;     ///< of a route
  double max_standby_s = 10;   ///< in standby, or blocked, for longer the rover keeps no goal
  /// Corners x, y, x, y, .. in the map, m, of the area that the rover may not leave; empty: none.
  std::vector<double> fence_m;

  void Check() const;
  ARFM_FIELDS(max_distance_m, max_waypoints, max_standby_s, fence_m)
};

/// Which goals are allowed, wherever they come from.
class GoalLimits {
 public:
  explicit GoalLimits(const GoalLimitsOptions& options) : options_(options) { options_.Check(); }

  /// Why `route` must not be driven from `start`, in words; empty where it may.
  std::string FindFlaw(const Route& route, const RoverPose& start) const;
  /// True where there is no fence.
  bool IsInsideFence(double x_m, double y_m) const;

 private:
  GoalLimitsOptions options_;
};

}  // namespace arfm_vo
