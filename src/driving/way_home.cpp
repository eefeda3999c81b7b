#include "arfm_vo/driving/way_home.h"

#include <algorithm>
#include <boost/geometry/algorithms/simplify.hpp>
#include <boost/geometry/geometries/linestring.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/strategies/cartesian/distance_projected_point.hpp>
#include <cmath>
#include <limits>

#include "arfm_vo/base/check.h"
#include "arfm_vo/base/format.h"

namespace arfm_vo {
namespace {

/// What was driven between poses that follow one another, at most; more is a gap.
constexpr double kMaxStep_m = 2;
/// Poses nearer to each other stand on the same ground.
constexpr double kMeeting_m = 0.5;
constexpr double kSmoothing_m = 0.1;

/// [driven] The next pose on the shortest way to the first one (Dijkstra 1959); -1: there is none.
std::vector<int> FindNext(const std::vector<RoverPose>& driven) {
  const int size = static_cast<int>(driven.size());
  constexpr double kFar = std::numeric_limits<double>::infinity();
  std::vector<double> way_m(size, kFar);
  std::vector<int> next(size, -1);
  std::vector<char> is_done(size, 0);
  way_m[0] = 0;
  next[0] = 0;
  while (true) {
    int nearest = -1;
    for (int i = 0; i < size; ++i)
      if (!is_done[i] && way_m[i] < (nearest < 0 ? kFar : way_m[nearest])) nearest = i;
    if (nearest < 0) return next;
    is_done[nearest] = 1;
    for (int i = 0; i < size; ++i) {
      const double step_m = Distance(driven[i], driven[nearest]);
      const bool is_driven = step_m <= (std::abs(i - nearest) == 1 ? kMaxStep_m : kMeeting_m);
      if (!is_driven || way_m[nearest] + step_m >= way_m[i]) continue;
      way_m[i] = way_m[nearest] + step_m;
      next[i] = nearest;
    }
  }
}

}  // namespace

Route FindWayHome(const std::vector<RoverPose>& driven, const RoverPose& rover) {
  Require(!driven.empty(), "way home: no path is known");
  const auto nearest =
      std::min_element(driven.begin(), driven.end(), [&](const RoverPose& a, const RoverPose& b) {
        return Distance(a, rover) < Distance(b, rover);
      });
  const double beside_m = Distance(*nearest, rover);
  Require(beside_m <= kMaxStep_m,
          Format("way home: the rover stands %.1f m beside the path", beside_m));
  const std::vector<int> next = FindNext(driven);
  using Point = boost::geometry::model::d2::point_xy<double>;
  boost::geometry::model::linestring<Point> way{{rover.x_m, rover.y_m}}, smooth;
  for (int i = static_cast<int>(nearest - driven.begin());; i = next[i]) {
    Require(next[i] >= 0, Format("way home: the path has a gap of more than %.0f m", kMaxStep_m));
    way.emplace_back(driven[i].x_m, driven[i].y_m);
    if (i == 0) break;
  }
  boost::geometry::simplify(way, smooth, kSmoothing_m);
  Route route;
  for (size_t i = 1; i < smooth.size(); ++i)
    route.push_back({smooth[i].x(), smooth[i].y(), std::nullopt});
  route.back().heading_rad = driven.front().heading_rad;
  return route;
}

}  // namespace arfm_vo
