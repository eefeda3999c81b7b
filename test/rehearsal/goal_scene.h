#pragma once

#include <memory>

#include "arfm_vo/base/fields.h"
#include "arfm_vo/driving/route.h"
#include "arfm_vo/simulation/drive_path.h"
#include "arfm_vo/simulation/terrain.h"
#include "arfm_vo/simulation/tracked_plant.h"

namespace arfm_vo {

struct GoalSceneOptions {
  GoalSceneOptions() { terrain.side_m = 102.4; }  // goals are near, and rendering starts sooner

  int seed = 1;
  double min_distance_m = 5, max_distance_m = 20;
  /// The steepest place on the straight way to the goal lies between these.
  double min_slope_deg = 5, max_slope_deg = 10;
  int num_threads = 1;
  TerrainOptions terrain;

  void Check() const;
  ARFM_FIELDS(seed, min_distance_m, max_distance_m, min_slope_deg, max_slope_deg, num_threads,
              terrain)
};

/// A piece of terrain with a place to start from and a goal, drawn at random: distance, direction
/// and heading. The way between is free of large rocks.
class GoalScene {
 public:
  GoalScene(const GoalSceneOptions& options, const RoverShape& shape);

  const Terrain& terrain() const { return *terrain_; }
  const RoverPose& start() const { return start_; }  ///< in the world
  const RoverPose& goal() const { return goal_; }    ///< in the world
  /// The goal as the map knows it, whose frame is the rover's base at the start.
  Waypoint GoalInMap() const;
  /// How the rover stands at a place.
  PlaceOnGround Ground() const { return GroundOf(*terrain_, shape_); }
  /// The steepest place of the straight way, degrees.
  double SteepestSlope() const { return steepest_deg_; }

 private:
  bool DrawWay(const GoalSceneOptions& options, RandomEngine& engine);
  double MeasureSlope() const;

  RoverShape shape_;
  std::unique_ptr<Terrain> terrain_;
  RoverPose start_, goal_;
  double steepest_deg_ = 0;
};

}  // namespace arfm_vo
