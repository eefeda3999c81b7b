#include "rehearsal/goal_scene.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "arfm_vo/base/check.h"

namespace arfm_vo {
namespace {

constexpr int kMaxDraws = 2000;
constexpr double kSlopeStep_m = 0.25;
constexpr double kCorridorStep_m = 1;

Corridor WayBetween(const RoverPose& start, const RoverPose& goal) {
  Corridor corridor;
  const Eigen::Vector2d from(start.x_m, start.y_m), to(goal.x_m, goal.y_m);
  const int num_steps = static_cast<int>(std::ceil((to - from).norm() / kCorridorStep_m));
  for (int i = 0; i <= num_steps; ++i)
    corridor.points.push_back(from + (to - from) * i / num_steps);
  return corridor;
}

}  // namespace

void GoalSceneOptions::Check() const {
  Require(min_distance_m > 0 && max_distance_m >= min_distance_m,
          "distances must be positive and in order");
  Require(min_slope_deg >= 0 && max_slope_deg > min_slope_deg && max_slope_deg <= 30,
          "slopes must be in 0..30 deg and in order");
  Require(num_threads >= 1, "num_threads must be at least 1");
  terrain.Check();
  Require(2.5 * max_distance_m < terrain.side_m, "max_distance_m is too far for terrain.side_m");
}

GoalScene::GoalScene(const GoalSceneOptions& options, const RoverShape& shape) : shape_(shape) {
  options.Check();
  TerrainOptions bare = options.terrain;
  bare.seed = options.seed;
  TerrainOptions rocky = bare;
  bare.rocks.density_per_m2 = 0;
  terrain_ = std::make_unique<Terrain>(bare, Corridor{}, options.num_threads);
  RandomEngine engine(options.seed);
  int num_draws = 0;
  while (!DrawWay(options, engine))
    Require(++num_draws < kMaxDraws,
            "seed " + std::to_string(options.seed) + ": the terrain has no way with such slopes");
  terrain_ = std::make_unique<Terrain>(rocky, WayBetween(start_, goal_), options.num_threads);
}

bool GoalScene::DrawWay(const GoalSceneOptions& options, RandomEngine& engine) {
  const auto between = [&](double low, double high) {
    return low + (high - low) * RandomUnit(engine);
  };
  const double distance_m = between(options.min_distance_m, options.max_distance_m);
  const double bearing_rad = between(-M_PI, M_PI);
  const double reach_m = options.terrain.side_m / 2 - 1.2 * options.max_distance_m;
  start_ = {between(-reach_m, reach_m), between(-reach_m, reach_m), between(-M_PI, M_PI)};
  goal_ = {start_.x_m + distance_m * std::cos(bearing_rad),
           start_.y_m + distance_m * std::sin(bearing_rad), between(-M_PI, M_PI)};
  steepest_deg_ = MeasureSlope();
  return steepest_deg_ >= options.min_slope_deg && steepest_deg_ <= options.max_slope_deg;
}

double GoalScene::MeasureSlope() const {
  const PlaceOnGround place = Ground();
  const double dx_m = goal_.x_m - start_.x_m, dy_m = goal_.y_m - start_.y_m;
  const int num_steps = static_cast<int>(std::ceil(std::hypot(dx_m, dy_m) / kSlopeStep_m));
  double steepest_deg = 0;
  for (int i = 0; i <= num_steps; ++i) {
    const double share = static_cast<double>(i) / num_steps;
    const RoverPose pose{start_.x_m + share * dx_m, start_.y_m + share * dy_m,
                         std::atan2(dy_m, dx_m)};
    steepest_deg = std::max(steepest_deg, SlopeOf(place(pose)));
  }
  return steepest_deg;
}

Waypoint GoalScene::GoalInMap() const {
  const PlaceOnGround place = Ground();
  return ToWaypoint(place(start_).Inverse() * place(goal_));
}

}  // namespace arfm_vo
