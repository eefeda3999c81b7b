#pragma once

#include <optional>

#include "arfm_vo/base/fields.h"
#include "arfm_vo/driving/pose_watch.h"
#include "arfm_vo/odometry/visual_odometry.h"
#include "arfm_vo/simulation/drive_path.h"
#include "arfm_vo/simulation/terrain_renderer.h"

namespace arfm_vo {

struct SimulatedSightOptions {
  /// Jagged edges: rendered in half the time, and not easier for the odometry.
  SimulatedSightOptions() { render.edge_samples = 1; }

  StereoRigOptions rig;
  double pair_period_s = 0.75;
  double latency_s = 0.2;  ///< from the exposure to the pose
  RenderOptions render;

  void Check() const;
  ARFM_FIELDS(rig, pair_period_s, latency_s, render)
};

/// What the rover's cameras tell it at one time.
struct Glimpse {
  double taken_s = 0, told_s = 0;       ///< when the pair was taken, and when its pose is known
  std::optional<Rigid3> map_from_base;  ///< nothing where the odometry is lost
  PoseUncertainty uncertainty;
};

/// Stereo pairs rendered where the rover truly stands, and the visual odometry that runs on them.
/// The map is the rover's base at the first pair.
class SimulatedSight {
 public:
  /// `terrain` must outlive this object.
  SimulatedSight(const SimulatedSightOptions& options, const OdometryOptions& odometry,
                 const RoverShape& shape, const Terrain& terrain);

  /// Takes a pair; times must rise.
  Glimpse Look(double now_s, const Rigid3& world_from_base);

 private:
  SimulatedSightOptions options_;
  StereoCamera camera_;
  Rigid3 base_from_camera_;
  TerrainRenderer renderer_;
  VisualOdometry odometry_;
  int num_pairs_ = 0;
};

}  // namespace arfm_vo
