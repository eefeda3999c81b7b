#pragma once

#include <Eigen/Core>
#include <vector>

#include "arfm_vo/base/fields.h"
#include "arfm_vo/simulation/height_grid.h"
#include "arfm_vo/simulation/noise_texture.h"
#include "arfm_vo/simulation/rock_field.h"

namespace arfm_vo {

struct TerrainOptions {
  int seed = 1;                     ///< another seed, another terrain
  double side_m = 204.8;            ///< of the square around the origin with full detail and rocks
  double cell_m = 0.1;              ///< of the height field; side_m / cell_m must be a power of two
  double relief_m = 1.0;            ///< height of the largest undulations
  double relief_wavelength_m = 18;  ///< of the largest undulations
  double hills_m = 90;              ///< height of the hills on the horizon
  double sand_fraction = 0.3;       ///< share of the ground with little texture
  double texture_contrast = 1;      ///< of the ground, 0: none, 1: as rendered for the fixture
  double sun_elevation_deg = 25;    ///< above the horizon
  double sun_azimuth_deg = 130;     ///< from +x towards +y
  RockOptions rocks;

  void Check() const;
  ARFM_FIELDS(seed, side_m, cell_m, relief_m, relief_wavelength_m, hills_m, sand_fraction,
              texture_contrast, sun_elevation_deg, sun_azimuth_deg, (rocks))
};

/// A way that is kept clear of large rocks and may have a surface of its own, like a road.
struct Corridor {
  std::vector<Eigen::Vector2d> points;  ///< about a metre apart; empty: no corridor
  double half_width_m = 1;
  double max_rock_radius_m = 0.12;
  double contrast = 1;  ///< times the ground's texture contrast
  double tone = 1;      ///< times the ground's brightness
};

/// A planetary surface: fractal relief, rocks, procedural texture with detail from 5 mm to tens of
/// metres, sandy patches, a low sun, hills on the horizon. World frame: z up, heights in metres. A
/// pure function of its options: the same on any number of threads.
class Terrain {
 public:
  explicit Terrain(const TerrainOptions& options, const Corridor& corridor = {},
                   int num_threads = 1);

  /// Of the ground, without rocks.
  double Height(double x, double y) const { return GridAt(x, y).Height(x, y); }
  Eigen::Vector3d Normal(double x, double y) const { return GridAt(x, y).Normal(x, y); }
  /// The parameter in [begin, end] at which a ray first meets the ground; infinity: none.
  double Intersect(const Ray& ray, double begin, double end) const;

  /// Direct sunlight on the ground (rocks' shadows left out) over that on level open ground.
  double Sunlight(double x, double y) const;
  /// The ground's reflectance, mean over a pixel's footprint.
  double GroundAlbedo(const TextureFootprint& footprint) const;
  /// The reflectance of a solid's face, mean over a pixel's footprint in the face's plane.
  double SolidAlbedo(const Solid& solid, const TextureFootprint& footprint) const;

  const RockField& rocks() const { return rocks_; }
  const Eigen::Vector3d& to_sun() const { return to_sun_; }
  const TerrainOptions& options() const { return options_; }

 private:
  const HeightGrid& GridAt(double x, double y) const { return near_.Contains(x, y) ? near_ : far_; }
  void RaiseGround(int num_threads);
  void PaintGround(const Corridor& corridor, int num_threads);
  void LightGround(int num_threads);
  void StrewRocks(const Corridor& corridor);
  double Detail(const TextureFootprint& footprint, int num_layers) const;

  TerrainOptions options_;
  Eigen::Vector3d to_sun_;
  HeightGrid near_, far_;
  Raster near_light_, far_light_;
  Raster sand_, contrast_, tone_, corridor_distance_;
  std::vector<Eigen::Vector2d> layer_shifts_;  ///< m, of each texture layer
  RockField rocks_;
};

}  // namespace arfm_vo
