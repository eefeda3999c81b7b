#include "arfm_vo/simulation/view_solids.h"

#include <algorithm>
#include <cmath>

namespace arfm_vo {
namespace {

constexpr int kTile = 8;                              ///< px
constexpr double kVanishPx = 0.8, kFullSizePx = 1.8;  ///< radii between which a solid shrinks away
constexpr double kNearest = 0.02;                     ///< m, before the camera

}  // namespace

ViewSolids::ViewSolids(const StereoCamera& camera, const Rigid3& world_from_camera,
                       const RockField& rocks, const std::vector<Solid>& bodies)
    : num_tiles_u_((camera.width + kTile - 1) / kTile),
      num_tiles_v_((camera.height + kTile - 1) / kTile) {
  const Rigid3 camera_from_world = world_from_camera.Inverse();
  for (const Solid& rock : rocks.rocks()) Add(rock, camera, camera_from_world);
  for (const Solid& body : bodies) {
    if (body.is_visible) Add(body, camera, camera_from_world);
  }
  tiles_.resize(num_tiles_u_ * num_tiles_v_);
  for (size_t i = 0; i < entries_.size(); ++i)
    for (int tv = entries_[i].low_v; tv <= entries_[i].high_v; ++tv)
      for (int tu = entries_[i].low_u; tu <= entries_[i].high_u; ++tu)
        tiles_[tv * num_tiles_u_ + tu].push_back(static_cast<int>(i));
}

bool ViewSolids::Bound(const Solid& solid, const Eigen::Vector3d& c, const StereoCamera& camera,
                       Entry& entry) const {
  const double radius = solid.bounding_radius_m;
  const double near = c.z() - radius, far = c.z() + radius;
  entry.low_u = entry.low_v = 0;
  entry.high_u = num_tiles_u_ - 1;
  entry.high_v = num_tiles_v_ - 1;
  if (near < kNearest) return true;  // about the camera: anywhere in the image
  const auto bound = [&](double x, double focal, double offset, int num_tiles, int& low,
                         int& high) {
    const double first = focal * std::min((x - radius) / near, (x - radius) / far) + offset - 1;
    const double last = focal * std::max((x + radius) / near, (x + radius) / far) + offset + 1;
    low = static_cast<int>(std::clamp(std::floor(first / kTile), 0.0, double(num_tiles)));
    high = static_cast<int>(std::clamp(std::floor(last / kTile), -1.0, num_tiles - 1.0));
    return low <= high;
  };
  return bound(c.x(), camera.fx, camera.cx, num_tiles_u_, entry.low_u, entry.high_u) &&
         bound(c.y(), camera.fy, camera.cy, num_tiles_v_, entry.low_v, entry.high_v);
}

void ViewSolids::Add(const Solid& solid, const StereoCamera& camera,
                     const Rigid3& camera_from_world) {
  const Eigen::Vector3d center = camera_from_world * solid.center;
  if (center.z() < -solid.bounding_radius_m) return;
  const double radius_px = camera.fx * solid.bounding_radius_m / std::max(center.norm(), 1e-3);
  if (radius_px <= kVanishPx) return;
  Entry entry;
  if (!Bound(solid, center, camera, entry)) return;
  entry.solid = &solid;
  if (radius_px < kFullSizePx) {
    shrunk_.push_back(solid);
    shrunk_.back().unit_from_world *= (kFullSizePx - kVanishPx) / (radius_px - kVanishPx);
    entry.solid = &shrunk_.back();
  }
  entries_.push_back(entry);
}

ViewSolids::Hit ViewSolids::Intersect(const Ray& ray, double u, double v, double end) const {
  const int tile_u = std::clamp(static_cast<int>(u / kTile), 0, num_tiles_u_ - 1);
  const int tile_v = std::clamp(static_cast<int>(v / kTile), 0, num_tiles_v_ - 1);
  const double direction_squared = ray.direction.squaredNorm();
  Hit best;
  for (const int entry : tiles_[tile_v * num_tiles_u_ + tile_u]) {
    const Solid& solid = *entries_[entry].solid;
    const Eigen::Vector3d offset = solid.center - ray.origin;
    const double along = offset.dot(ray.direction);
    const double miss_squared = offset.squaredNorm() - along * along / direction_squared;
    if (miss_squared > solid.bounding_radius_m * solid.bounding_radius_m) continue;
    const SolidHit hit = solid.Intersect(ray, kNearest, end);
    if (hit.parameter >= end) continue;
    end = hit.parameter;
    best = {hit, &solid, entry};
  }
  return best;
}

}  // namespace arfm_vo
