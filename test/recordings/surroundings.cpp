#include <algorithm>
#include <cmath>

#include "recordings/rendered_drive.h"

namespace arfm_vo {
namespace {

constexpr double kMargin = 25;  ///< m of detailed ground around the path

/// The rectangle along the first heading around a path, m.
struct Bounds {
  Eigen::Rotation2Dd world_from_way;
  Eigen::Vector2d low, high;  ///< along and across the way

  explicit Bounds(const PlanarPath& path) : world_from_way(path.front().heading_rad) {
    low = high = world_from_way.inverse() * PositionOf(path.front());
    for (const RoverPose& pose : path) {
      const Eigen::Vector2d position = world_from_way.inverse() * PositionOf(pose);
      low = low.cwiseMin(position);
      high = high.cwiseMax(position);
    }
  }
};

/// Boxes with a texture of their own each, upright along the way.
class Builder {
 public:
  Builder(const DrivePlan& plan, const PlanarPath& path)
      : bounds_(path), draw_(static_cast<uint32_t>(plan.seed) + 1) {}

  /// From `low` to `high`: along the way, across it, up.
  void AddBox(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
    const Eigen::Vector3d middle = (low + high) / 2;
    Eigen::Vector3d center;
    center << bounds_.world_from_way * Eigen::Vector2d(middle.head<2>()), middle.z();
    const Eigen::AngleAxisd turn(bounds_.world_from_way.angle(), Eigen::Vector3d::UnitZ());
    Solid box = MakeBox({Eigen::Quaterniond(turn), center}, (high - low) / 2);
    box.albedo = draw_.Between(0.25, 0.6);
    box.contrast = draw_.Between(0.4, 1);
    box.texture_offset_m = {draw_.Between(0, 500), draw_.Between(0, 500)};
    boxes_.push_back(box);
  }

  /// Walls on both sides and at both ends, at times a ceiling.
  std::vector<Solid> Corridor(double camera_height_m) {
    const double aside = draw_.Between(1, 2) * std::max(0.6, camera_height_m);
    const double height = camera_height_m + draw_.Between(0.6, 2);
    const double back = bounds_.low.x() - 3, front = bounds_.high.x() + draw_.Between(4, 20);
    const double right = bounds_.low.y() - aside, left = bounds_.high.y() + aside;
    constexpr double kThick = 0.2, kDeep = -2;
    AddBox({back, left, kDeep}, {front, left + kThick, height});
    AddBox({back, right - kThick, kDeep}, {front, right, height});
    AddBox({front, right, kDeep}, {front + kThick, left, height});
    AddBox({back - kThick, right, kDeep}, {back, left, height});
    if (draw_.Chance(0.5)) AddBox({back, right, height}, {front, left, height + kThick});
    return boxes_;
  }

  std::vector<Solid> Street() {
    for (const double side : {-1.0, 1.0}) {
      const double edge = side < 0 ? -bounds_.low.y() : bounds_.high.y();
      const double end = bounds_.high.x() + 35;
      for (double along = bounds_.low.x() - 8; along < end && boxes_.size() < 40;) {
        const double length = draw_.Between(5, 12);
        AddRow(side, edge + draw_.Between(5, 8), along, length, 8, draw_.Between(4, 11));
        if (draw_.Chance(0.5)) {
          AddRow(side, edge + draw_.Between(2, 2.6), along, 4, 1.7, draw_.Between(1.3, 1.8));
        }
        along += length + (draw_.Chance(0.3) ? draw_.Between(2, 6) : 0);
      }
    }
    return boxes_;
  }

 private:
  void AddRow(double side, double aside, double along, double length, double depth, double height) {
    const double near = side * aside, far = side * (aside + depth);
    AddBox({along, std::min(near, far), -2}, {along + length, std::max(near, far), height});
  }

  Bounds bounds_;
  Draw draw_;
  std::vector<Solid> boxes_;
};

void SetGround(const DrivePlan& plan, Draw& draw, Surroundings& around) {
  const std::string& scene = plan.scene;
  TerrainOptions& terrain = around.terrain;
  terrain.relief_m = draw.Between(0.1, 0.6);
  terrain.rocks.density_per_m2 = draw.Between(2, 8);
  if (scene == "sand") {
    terrain.sand_fraction = draw.Between(0.7, 1);
    terrain.rocks.density_per_m2 = draw.Between(0.5, 3);
  } else if (scene == "leaves") {
    terrain.rocks = {draw.Between(15, 30), 0.025, 0.09, 1.2, 0.2};
    terrain.relief_m = 0.1;
  } else if (scene == "little_texture") {
    terrain.texture_contrast = draw.Between(0.08, 0.3);
    terrain.rocks.density_per_m2 = draw.Between(0.05, 0.5);
  } else if (scene == "repeating") {
    terrain.texture_contrast = draw.Between(0.1, 0.3);
    terrain.rocks.density_per_m2 = 0.05;
    terrain.relief_m = 0.02;
    // It moves by less than half a tile from pair to pair: what is seen is not ambiguous.
    around.tile_m = std::max(draw.Between(0.08, 0.5), 2.2 * plan.step_m);
    around.tile_contrast = draw.Between(0.3, 0.6);
  } else if (scene == "night") {
    around.has_lamp = true;
    around.skylight = 1;  // no sun
  } else if (scene == "corridor" || scene == "street") {
    terrain.relief_m = 0.02;
    terrain.rocks.density_per_m2 = 0.02;
    terrain.texture_contrast = draw.Between(0.2, 0.8);
    around.skylight = draw.Between(0.4, 0.9);
  }
}

}  // namespace

Surroundings MakeSurroundings(const DrivePlan& plan, const PlanarPath& path) {
  Draw draw(static_cast<uint32_t>(plan.seed) + 2);
  Surroundings around;
  TerrainOptions& terrain = around.terrain;
  terrain.seed = plan.seed;
  terrain.sun_elevation_deg = draw.Between(15, 60);
  terrain.sun_azimuth_deg = draw.Between(0, 360);
  SetGround(plan, draw, around);
  double half = kMargin;
  for (const RoverPose& pose : path)
    half = std::max({half, kMargin + std::abs(pose.x_m), kMargin + std::abs(pose.y_m)});
  around.way.points = FollowPath(path, 5);
  around.way.half_width_m = plan.shape.track_gauge_m;
  around.way.max_rock_radius_m = 0.15 * plan.shape.camera_height_m;
  double cells = 128;
  while (cells < 1024 && cells * terrain.cell_m < 2 * half) cells *= 2;
  while (cells * terrain.cell_m < 2 * half) terrain.cell_m *= 2;
  terrain.side_m = cells * terrain.cell_m;
  return around;
}

std::vector<Solid> MakeBuildings(const DrivePlan& plan, const PlanarPath& path) {
  Builder builder(plan, path);
  if (plan.scene == "corridor") return builder.Corridor(plan.shape.camera_height_m);
  if (plan.scene == "street") return builder.Street();
  return {};
}

}  // namespace arfm_vo
