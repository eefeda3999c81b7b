#include "arfm_vo/driving/goal_limits.h"

#include <cmath>

#include "arfm_vo/base/format.h"
#include "arfm_vo/base/range_check.h"

namespace arfm_vo {
namespace {

constexpr size_t kMaxWaypoints = 100;  ///< of a route

/// Twice the area of the triangle a, b, c; positive where it turns left.
template <class Point>
double Turn(const Point& a, const Point& b, const Point& c) {
  return (b.x_m - a.x_m) * (c.y_m - a.y_m) - (b.y_m - a.y_m) * (c.x_m - a.x_m);
}

std::string NameOf(size_t index, size_t size) {
  return size == 1 ? "it" : "waypoint " + std::to_string(index);
}

}  // namespace

void GoalLimitsOptions::Check() const {
  RequireAbove(max_distance_m, 0, 100000, "goal_limits.max_distance_m");
  RequireInRange(max_standby_s, 0, 3600, "goal_limits.max_standby_s");
  Require(fence_m.size() % 2 == 0 && (fence_m.empty() || fence_m.size() >= 6),
          "goal_limits.fence_m must hold x and y of three corners or more");
  for (const double value : fence_m)
    Require(std::abs(value) <= 1e5, "goal_limits.fence_m must be finite and within 100 km");
}

GoalLimits::GoalLimits(const GoalLimitsOptions& options) : options_(options) {
  options_.Check();
  for (size_t i = 0; i + 1 < options_.fence_m.size(); i += 2)
    fence_.push_back({options_.fence_m[i], options_.fence_m[i + 1]});
}

bool GoalLimits::IsInsideFence(double x_m, double y_m) const {
  if (fence_.empty()) return true;
  bool is_inside = false;  // changes at each edge that a ray along +x crosses
  for (size_t i = 0, j = fence_.size() - 1; i < fence_.size(); j = i++) {
    const Corner &a = fence_[i], &b = fence_[j];
    if ((a.y_m > y_m) == (b.y_m > y_m)) continue;
    if (x_m < a.x_m + (b.x_m - a.x_m) * (y_m - a.y_m) / (b.y_m - a.y_m)) is_inside = !is_inside;
  }
  return is_inside;
}

bool GoalLimits::CrossesFence(const Corner& from, const Corner& to) const {
  for (size_t i = 0, j = fence_.size() - 1; i < fence_.size(); j = i++) {
    const Corner &a = fence_[j], &b = fence_[i];
    if (Turn(a, b, from) * Turn(a, b, to) < 0 && Turn(from, to, a) * Turn(from, to, b) < 0)
      return true;
  }
  return false;
}

std::string GoalLimits::FindFlaw(const Route& route, const RoverPose& start) const {
  if (route.size() > kMaxWaypoints)
    return "it has more than " + std::to_string(kMaxWaypoints) + " waypoints";
  Corner from{start.x_m, start.y_m};
  for (size_t i = 0; i < route.size(); ++i) {
    const Corner to{route[i].x_m, route[i].y_m};
    const double distance_m = std::hypot(to.x_m - start.x_m, to.y_m - start.y_m);
    if (!(distance_m <= options_.max_distance_m))
      return NameOf(i, route.size()) +
             Format(" is %.1f m away, farther than %.1f m", distance_m, options_.max_distance_m);
    if (!IsInsideFence(to.x_m, to.y_m)) return NameOf(i, route.size()) + " is outside the fence";
    if (CrossesFence(from, to))
      return "the way to " + NameOf(i, route.size()) + " leaves the fence";
    from = to;
  }
  return "";
}

}  // namespace arfm_vo
