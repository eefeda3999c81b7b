#pragma once

#include <memory>
#include <vector>

#include "arfm_vo/simulation/terrain_renderer.h"
#include "recordings/drive_plan.h"
#include "recordings/pair_source.h"

namespace arfm_vo {

/// Ground, and what stands on it, around a path. Walls and houses follow the path's bounding
/// rectangle, so that any path is clear of them.
struct Surroundings {
  TerrainOptions terrain;
  Corridor way;
  double skylight = 0.22;
  bool has_lamp = false;  ///< at the camera, and hardly any other light
  double tile_m = 0;      ///< of a pattern that repeats on the ground; 0: none
  double tile_contrast = 0;
};
Surroundings MakeSurroundings(const DrivePlan& plan, const PlanarPath& path);
/// Walls of a corridor, houses and parked cars of a street; nothing elsewhere.
std::vector<Solid> MakeBuildings(const DrivePlan& plan, const PlanarPath& path);

/// A drive that is rendered as it is taken: exact calibration, poses and depths.
class RenderedDrive : public PairSource {
 public:
  explicit RenderedDrive(const DrivePlan& plan, int num_threads = 1);

  const StereoCamera& camera() const override { return plan_.camera; }
  int size() const override { return static_cast<int>(world_from_left_.size()); }
  const Rigid3& WorldFromLeft(int pair) const override { return world_from_left_.at(pair); }
  TruePair Take(int pair) const override;

 private:
  cv::Mat See(const Rigid3& world_from_camera, const Eigen::Vector3d& lamp, uint32_t image_id,
              cv::Mat* depth_m) const;
  template <class Change>
  void ForEachPoint(const Rigid3& world_from_camera, RenderedView& view,
                    const Change& change) const;
  void LightByLamp(const Rigid3& world_from_camera, const Eigen::Vector3d& lamp,
                   RenderedView& view) const;
  void LayTiles(const Rigid3& world_from_camera, RenderedView& view) const;
  void PlaceCamera(const PlanarPath& path);

  DrivePlan plan_;
  Surroundings surroundings_;
  std::vector<Solid> buildings_;
  std::unique_ptr<Terrain> terrain_;
  std::unique_ptr<TerrainRenderer> renderer_;
  SensorOptions sensor_;
  std::vector<Rigid3> world_from_left_;
};

}  // namespace arfm_vo
