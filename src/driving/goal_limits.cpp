#include "arfm_vo/driving/goal_limits.h"

#include <boost/geometry.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <cmath>

#include "arfm_vo/base/format.h"
#include "arfm_vo/base/range_check.h"

namespace arfm_vo {
namespace {

namespace bg = boost::geometry;
using Place = bg::model::d2::point_xy<double>;

bg::model::ring<Place> MakeRing(const std::vector<double>& corners_m) {
  bg::model::ring<Place> ring;
  for (size_t i = 0; i + 1 < corners_m.size(); i += 2)
    ring.emplace_back(corners_m[i], corners_m[i + 1]);
  bg::correct(ring);  // whichever way round the corners are
  return ring;
}

std::string NameOf(size_t index, size_t size) {
  return size == 1 ? "it" : "waypoint " + std::to_string(index);
}

}  // namespace

void GoalLimitsOptions::Check() const {
  RequireAbove(max_distance_m, 0, 100000, "goal_limits.max_distance_m");
  RequireInRange(max_waypoints, 1, 100000, "goal_limits.max_waypoints");
  RequireInRange(max_standby_s, 0, 3600, "goal_limits.max_standby_s");
  Require(fence_m.size() % 2 == 0 && (fence_m.empty() || fence_m.size() >= 6),
          "goal_limits.fence_m must hold x and y of three corners or more");
  for (const double value : fence_m)
    Require(std::abs(value) <= 1e5, "goal_limits.fence_m must be finite and within 100 km");
  Require(fence_m.empty() || bg::is_valid(MakeRing(fence_m)),
          "goal_limits.fence_m must enclose an area and not cross itself");
}

bool GoalLimits::IsInsideFence(double x_m, double y_m) const {
  return options_.fence_m.empty() || bg::covered_by(Place(x_m, y_m), MakeRing(options_.fence_m));
}

std::string GoalLimits::FindFlaw(const Route& route, const RoverPose& start) const {
  if (route.size() > static_cast<size_t>(options_.max_waypoints))
    return "it has more than " + std::to_string(options_.max_waypoints) + " waypoints";
  const auto fence = MakeRing(options_.fence_m);
  Place from(start.x_m, start.y_m);
  for (size_t i = 0; i < route.size(); ++i) {
    const Place to(route[i].x_m, route[i].y_m);
    const double distance_m = std::hypot(to.x() - start.x_m, to.y() - start.y_m);
    if (!(distance_m <= options_.max_distance_m))
      return NameOf(i, route.size()) +
             Format(" is %.1f m away, farther than %.1f m", distance_m, options_.max_distance_m);
    if (fence.empty()) continue;
    if (!bg::covered_by(to, fence)) return NameOf(i, route.size()) + " is outside the fence";
    if (!bg::covered_by(bg::model::linestring<Place>{from, to}, fence))
      return "the way to " + NameOf(i, route.size()) + " leaves the fence";
    from = to;
  }
  return "";
}

}  // namespace arfm_vo
