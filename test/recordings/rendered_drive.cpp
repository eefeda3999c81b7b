#include "recordings/rendered_drive.h"

#include <cmath>

namespace arfm_vo {
namespace {

constexpr double kLampReach = 3;  ///< times the camera's height: as bright as the sun there
constexpr double kMaxLight = 1.6;
constexpr double kShadeGain = 1.8;       ///< where hardly anything stands in the sun
constexpr double kNightSkylight = 0.02;  ///< of what the day has

/// Brightness, about 1, of a smooth pattern of tiles at (x, y), mean over a pixel's footprint of
/// `width_m`: a sine's mean over a Gaussian footprint.
double Tiles(double x, double y, double tile_m, double contrast, double width_m) {
  const double wave = 2 * M_PI / tile_m;
  const double blur = std::exp(-0.5 * std::pow(0.5 * wave * width_m, 2));
  const double pattern = std::sin(wave * x) * std::sin(wave * y) +
                         0.5 * blur * std::sin(2 * wave * x + 1) * std::sin(2 * wave * y);
  return 1 + contrast * blur * pattern;
}

}  // namespace

RenderedDrive::RenderedDrive(const DrivePlan& plan, int num_threads) : plan_(plan) {
  const PlanarPath path = MakePath(plan);
  surroundings_ = MakeSurroundings(plan, path);
  buildings_ = MakeBuildings(plan, path);
  terrain_ = std::make_unique<Terrain>(surroundings_.terrain, surroundings_.way, num_threads);
  RenderOptions render;
  render.num_threads = num_threads;
  render.skylight = surroundings_.skylight;
  sensor_ = render.sensor;
  if (plan.scene == "corridor") sensor_.gain *= kShadeGain;
  sensor_.noise_grey_levels = plan.noise_grey_levels;
  sensor_.seed = plan.seed;
  renderer_ = std::make_unique<TerrainRenderer>(*terrain_, render);
  PlaceCamera(path);
}

void RenderedDrive::PlaceCamera(const PlanarPath& path) {
  Draw draw(static_cast<uint32_t>(plan_.seed) + 3);
  const Rigid3 base_from_left = BaseFromLeftCamera(plan_.shape);
  for (const RoverPose& pose : path) {
    const Eigen::Vector3d turn(draw.Gaussian(), draw.Gaussian(), draw.Gaussian());
    const Eigen::Vector3d shift(0, draw.Gaussian(), 0);
    const double jolt_m = 0.3 * plan_.shake_rad * plan_.shape.camera_height_m;
    world_from_left_.push_back(PlaceRover(*terrain_, pose, plan_.shape) * base_from_left *
                               Rigid3(ExpSO3(plan_.shake_rad * turn), jolt_m * shift));
  }
}

TruePair RenderedDrive::Take(int pair) const {
  const Rigid3& world_from_left = world_from_left_.at(pair);
  TruePair taken;
  taken.images.stamp_s = plan_.interval_s * pair;
  const Eigen::Vector3d lamp =
      world_from_left * Eigen::Vector3d(plan_.camera.baseline_m / 2, -plan_.camera.baseline_m, 0);
  taken.images.left = See(world_from_left, lamp, 2 * pair, &taken.depth_m);
  taken.images.right =
      See(RightCameraPose(plan_.camera, world_from_left), lamp, 2 * pair + 1, nullptr);
  return taken;
}

cv::Mat RenderedDrive::See(const Rigid3& world_from_camera, const Eigen::Vector3d& lamp,
                           uint32_t image_id, cv::Mat* depth_m) const {
  RenderedView view = renderer_->Trace(plan_.camera, world_from_camera, buildings_);
  if (surroundings_.has_lamp) LightByLamp(world_from_camera, lamp, view);
  if (surroundings_.tile_m > 0) LayTiles(world_from_camera, view);
  if (depth_m != nullptr) *depth_m = view.depth;
  return ExposeImage(view.radiance, sensor_, image_id);
}

template <class Change>
void RenderedDrive::ForEachPoint(const Rigid3& world_from_camera, RenderedView& view,
                                 const Change& change) const {
  const StereoCamera& camera = plan_.camera;
  for (int v = 0; v < view.radiance.rows; ++v) {
    for (int u = 0; u < view.radiance.cols; ++u) {
      const double z = std::min(1e5, static_cast<double>(view.depth.at<float>(v, u)));
      const Eigen::Vector3d x_in_camera(z * (u - camera.cx) / camera.fx,
                                        z * (v - camera.cy) / camera.fy, z);
      change(world_from_camera * x_in_camera, z, view.radiance.at<float>(v, u));
    }
  }
}

void RenderedDrive::LightByLamp(const Rigid3& world_from_camera, const Eigen::Vector3d& lamp,
                                RenderedView& view) const {
  const double reach_m = kLampReach * plan_.shape.camera_height_m;
  ForEachPoint(world_from_camera, view, [&](const Eigen::Vector3d& point, double, float& radiance) {
    const double light = reach_m * reach_m / (point - lamp).squaredNorm();
    radiance *= static_cast<float>(std::min(kMaxLight, kNightSkylight + light));
  });
}

void RenderedDrive::LayTiles(const Rigid3& world_from_camera, RenderedView& view) const {
  ForEachPoint(
      world_from_camera, view, [&](const Eigen::Vector3d& point, double z, float& radiance) {
        const Eigen::Vector3d away = point - world_from_camera.translation;
        const double slant = std::max(0.02, std::abs(away.z()) / away.norm());
        radiance *=
            static_cast<float>(Tiles(point.x(), point.y(), surroundings_.tile_m,
                                     surroundings_.tile_contrast, z / (plan_.camera.fx * slant)));
      });
}

}  // namespace arfm_vo
