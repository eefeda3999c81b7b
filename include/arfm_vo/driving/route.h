#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "arfm_vo/geometry/rigid3.h"

namespace arfm_vo {

/// `angle_rad` brought to (-pi, pi].
inline double WrapAngle(double angle_rad) {
  const double wrapped = std::remainder(angle_rad, 2 * M_PI);
  return wrapped <= -M_PI ? M_PI : wrapped;
}

/// Where the rover's base stands on the map's x-y plane.
struct RoverPose {
  double x_m = 0;
  double y_m = 0;
  double heading_rad = 0;  ///< of the base's x axis, from the map's x axis towards its y axis
};

/// The pose seen from above. The base's x axis must not stand on end.
RoverPose ProjectToPlane(const Rigid3& map_from_base);

/// The pose on the plane: level, at height 0.
Rigid3 LiftFromPlane(const RoverPose& pose);

/// Between the base's z axis and the plane's normal, rad.
double TiltOf(const Rigid3& map_from_base);

/// From place to place, m, whatever the headings.
inline double Distance(const RoverPose& a, const RoverPose& b) {
  return std::hypot(a.x_m - b.x_m, a.y_m - b.y_m);
}

/// The pose after `forward_m` along an arc that turns by `turn_rad`.
RoverPose Advance(const RoverPose& pose, double forward_m, double turn_rad);

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
