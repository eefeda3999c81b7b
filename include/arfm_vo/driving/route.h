#pragma once

#include <optional>
#include <string>
#include <vector>

#include "arfm_vo/geometry/rigid3.h"

namespace arfm_vo {

/// A place on the map's x-y plane to pass, or to stop at.
struct Waypoint {
  double x_m = 0;
  double y_m = 0;
  std::optional<double> heading_rad;  ///< to be taken there; counts at the last waypoint only
};
using Route = std::vector<Waypoint>;

/// Why `pose` can be no goal, in words for the one who sent it: not finite, a quaternion that is
/// not of unit length, an x axis that stands on end. Empty where it can.
std::string FindGoalFlaw(const Rigid3& map_from_goal);

/// The waypoint at a goal without flaws, with its heading.
Waypoint ToWaypoint(const Rigid3& map_from_goal);

}  // namespace arfm_vo
