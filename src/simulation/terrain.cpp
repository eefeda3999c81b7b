#include "arfm_vo/simulation/terrain.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "arfm_vo/base/range_check.h"
#include "arfm_vo/simulation/hash_noise.h"

namespace arfm_vo {
namespace {

constexpr double kFarSide = 8192, kFarCell = 16;  ///< m, of the land around the detailed square
constexpr double kGroundAlbedo = 0.42;
/// Height of each octave of the relief over that of the one twice as long.
constexpr double kPersistence = 0.48;
constexpr int kNumLayers = 5;
/// Of the texture layers: each band of 8 in wavelength follows the next.
constexpr double kTexels[kNumLayers] = {0.0025, 0.02, 0.16, 1.28, 10.24};
constexpr double kAmplitudes[kNumLayers] = {0.2, 0.2, 0.11, 0.13, 0.13};

double DistanceToPolyline(const std::vector<Eigen::Vector2d>& points, const Eigen::Vector2d& p) {
  double nearest = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i + 1 < points.size(); ++i) {
    const Eigen::Vector2d segment = points[i + 1] - points[i];
    const double along =
        std::clamp((p - points[i]).dot(segment) / std::max(segment.squaredNorm(), 1e-12), 0.0, 1.0);
    nearest = std::min(nearest, (p - points[i] - along * segment).squaredNorm());
  }
  return std::sqrt(nearest);
}

/// 1 in a sandy patch, 0 outside.
double SandShare(const TerrainOptions& options, double x, double y) {
  const uint32_t seed = HashWord(options.seed) + 300;
  const double shore = 0.4 - 0.8 * options.sand_fraction;  // the noise is within about +-0.5
  return SmoothStep(shore - 0.08, shore + 0.08, FractalNoise(x / 9, y / 9, 4, 0.5, seed));
}

/// The fine layers' pattern: noise and pebbles. The same for all terrains, made once.
const NoiseTexture& Gravel() {
  static const NoiseTexture texture(11, 0.012, 1);
  return texture;
}

/// The coarse layers' pattern.
const NoiseTexture& Soil() {
  static const NoiseTexture texture(10, 0, 2);
  return texture;
}

Raster MakeSquare(double side_m, double cell_m) {
  return Raster(Eigen::Vector2d::Constant(-side_m / 2), cell_m,
                static_cast<int>(std::lround(side_m / cell_m)));
}

}  // namespace

void TerrainOptions::Check() const {
  Require(cell_m > 0 && side_m > 0, "terrain.side_m and terrain.cell_m must be positive");
  const long cells = std::lround(side_m / cell_m);
  Require(cells >= 2 && cells <= 8192 && (cells & (cells - 1)) == 0 &&
              std::abs(cells * cell_m - side_m) < 1e-6 * side_m,
          "terrain.side_m must be terrain.cell_m times a power of two up to 8192");
  Require(side_m < kFarSide / 2, "terrain.side_m must be below 4096");
  Require(relief_wavelength_m > 0, "terrain.relief_wavelength_m must be positive");
  RequireInRange(sand_fraction, 0, 1, "terrain.sand_fraction");
  Require(texture_contrast >= 0, "terrain.texture_contrast must not be negative");
  RequireInRange(sun_elevation_deg, 3, 90, "terrain.sun_elevation_deg");
}

Terrain::Terrain(const TerrainOptions& options, const Corridor& corridor, int num_threads)
    : options_(options) {
  options.Check();
  const double elevation = options.sun_elevation_deg * M_PI / 180;
  const double azimuth = options.sun_azimuth_deg * M_PI / 180;
  to_sun_ = {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
             std::sin(elevation)};
  for (int layer = 0; layer < kNumLayers; ++layer) {
    const uint32_t word = HashCell(layer, options.seed, 500);
    layer_shifts_.push_back(kTexels[layer] * Eigen::Vector2d(word & 0x7ff, (word >> 16) & 0x7ff));
  }
  RaiseGround(num_threads);
  PaintGround(corridor, num_threads);
  LightGround(num_threads);
  StrewRocks(corridor);
}

void Terrain::RaiseGround(int num_threads) {
  const uint32_t seed = HashWord(options_.seed);
  const double finest = 4 * options_.cell_m;
  const int num_octaves =
      1 + std::max(0, static_cast<int>(std::log2(options_.relief_wavelength_m / finest)));
  const double half = options_.side_m / 2, coarse = 150;
  const auto land = [=](double x, double y) {
    const double distance = std::hypot(x, y);
    const double hills = options_.hills_m * SmoothStep(1.5 * half, 1.5 * half + 900, distance);
    const double rolling = hills > 0 ? 0.5 + FractalNoise(x / 700, y / 700, 4, 0.5, seed + 100) : 0;
    return hills * rolling +
           3 * options_.relief_m * GradientNoise(x / coarse, y / coarse, seed + 200);
  };
  const auto ground = [=](double x, double y) {
    // The fine relief ends where the coarse grid takes over.
    const double edge = std::max(std::abs(x), std::abs(y)) / half;
    const double wave = options_.relief_wavelength_m;
    return land(x, y) + options_.relief_m * (1 - SmoothStep(0.85, 1, edge)) *
                            FractalNoise(x / wave, y / wave, num_octaves, kPersistence, seed);
  };
  Raster near = MakeSquare(options_.side_m, options_.cell_m);
  near.Fill(num_threads, ground);
  near_ = HeightGrid(std::move(near));
  Raster far = MakeSquare(kFarSide, kFarCell);
  far.Fill(num_threads, land);
  far_ = HeightGrid(std::move(far));
}

void Terrain::PaintGround(const Corridor& corridor, int num_threads) {
  const double cell = std::max(options_.cell_m, options_.side_m / 1024);
  corridor_distance_ = MakeSquare(options_.side_m, options_.side_m / 256);
  corridor_distance_.Fill(num_threads, [&](double x, double y) {
    return std::min(1e6, DistanceToPolyline(corridor.points, {x, y}));
  });
  const auto on_way = [&](double x, double y) {
    const double edge = corridor.half_width_m;
    return 1 - SmoothStep(edge, edge + 2 * cell, corridor_distance_.Sample(x, y));
  };
  contrast_ = tone_ = sand_ = MakeSquare(options_.side_m, cell);
  sand_.Fill(num_threads, [&](double x, double y) { return SandShare(options_, x, y); });
  contrast_.Fill(num_threads, [&](double x, double y) {
    return options_.texture_contrast * (1 - 0.8 * sand_.Sample(x, y)) *
           (1 + (corridor.contrast - 1) * on_way(x, y));
  });
  tone_.Fill(num_threads, [&](double x, double y) {
    return (1 + 0.1 * sand_.Sample(x, y)) * (1 + (corridor.tone - 1) * on_way(x, y));
  });
}

void Terrain::LightGround(int num_threads) {
  for (const bool is_near : {true, false}) {
    const HeightGrid& grid = is_near ? near_ : far_;
    Raster& light = is_near ? near_light_ : far_light_;
    light = MakeSquare(is_near ? options_.side_m : kFarSide, grid.heights().cell_m());
    light.Fill(num_threads, [&](double x, double y) {
      const double lambert = std::max(0.0, grid.Normal(x, y).dot(to_sun_)) / to_sun_.z();
      const Ray ray{{x, y, grid.Height(x, y) + 0.15 * grid.heights().cell_m()}, to_sun_};
      return grid.Intersect(ray, 0, 1e4) < 1e4 ? 0.0 : lambert;
    });
  }
}

void Terrain::StrewRocks(const Corridor& corridor) {
  const uint32_t seed = HashWord(options_.seed) + 400;
  RockBed bed;
  bed.height_m = [&](double x, double y) { return near_.Height(x, y); };
  bed.cover = [&](double x, double y) {
    const double clump = SmoothStep(-0.35, 0.35, FractalNoise(x / 11, y / 11, 3, 0.6, seed));
    return clump * (1 - 0.9 * sand_.Sample(x, y));
  };
  bed.max_radius_m = [&](double x, double y) {
    const double distance = corridor_distance_.Sample(x, y);
    return std::max(corridor.max_rock_radius_m, distance - corridor.half_width_m);
  };
  rocks_ = RockField(options_.rocks, bed, options_.side_m, to_sun_, seed);
}

double Terrain::Intersect(const Ray& ray, double begin, double end) const {
  double near_begin = begin, near_end = end;
  if (!near_.ClipToSquare(ray, near_begin, near_end)) return far_.Intersect(ray, begin, end);
  const double before = near_begin > begin ? far_.Intersect(ray, begin, near_begin) : INFINITY;
  if (before < near_begin) return before;
  const double within = near_.Intersect(ray, near_begin, near_end);
  if (within <= near_end) return within;
  return near_end < end ? far_.Intersect(ray, near_end, end) : INFINITY;
}

double Terrain::Sunlight(double x, double y) const {
  return near_.Contains(x, y) ? near_light_.Sample(x, y) : far_light_.Sample(x, y);
}

double Terrain::Detail(const TextureFootprint& footprint, int num_layers) const {
  TextureProbes probes(footprint);
  double detail = 0;
  for (int layer = 0; layer < num_layers; ++layer) {
    probes.center = footprint.center + layer_shifts_[layer];
    const NoiseTexture& texture = layer < 2 ? Gravel() : Soil();
    detail += kAmplitudes[layer] * texture.SampleMean(probes, kTexels[layer]);
  }
  return detail;
}

double Terrain::GroundAlbedo(const TextureFootprint& footprint) const {
  const double x = footprint.center.x(), y = footprint.center.y();
  const bool is_near = near_.Contains(x, y);
  const double contrast = is_near ? contrast_.Sample(x, y) : options_.texture_contrast;
  const double tone = is_near ? tone_.Sample(x, y) : 1;
  return tone * kGroundAlbedo * std::max(0.1, 1 + contrast * Detail(footprint, kNumLayers));
}

double Terrain::SolidAlbedo(const Solid& solid, const TextureFootprint& footprint) const {
  TextureFootprint shifted = footprint;
  shifted.center += solid.texture_offset_m;
  return solid.albedo * std::max(0.1, 1 + solid.contrast * Detail(shifted, 3));
}

}  // namespace arfm_vo
