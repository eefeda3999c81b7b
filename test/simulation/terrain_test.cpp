#include "arfm_vo/simulation/terrain.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/refusal.h"

namespace arfm_vo {
namespace {

TerrainOptions SmallOptions() {
  TerrainOptions options;
  options.side_m = 25.6;
  return options;
}

TEST(Terrain, CorridorIsClearOfLargeRocks) {
  Corridor corridor;
  corridor.points = {{-10, 0}, {0, 2}, {10, 0}};
  corridor.half_width_m = 2;
  corridor.max_rock_radius_m = 0.05;
  const Terrain terrain(SmallOptions(), corridor);
  int num_on_way = 0;
  for (const Solid& rock : terrain.rocks().rocks()) {
    const Eigen::Vector2d p = rock.center.head<2>();
    if (std::abs(p.x()) > 10 || std::abs(p.y() - 2 + std::abs(p.x()) / 5) > 1.9) continue;
    ++num_on_way;
    EXPECT_LE(rock.bounding_radius_m, 1.3 * 0.05);
  }
  EXPECT_GT(num_on_way, 20);
}

TEST(Terrain, CheckNamesTheBadOption) {
  TerrainOptions options = SmallOptions();
  EXPECT_NO_THROW(Terrain{options});
  options.cell_m = 0.09;
  EXPECT_INVALID(Terrain{options}, "terrain.cell_m");
  options = SmallOptions();
  options.sun_elevation_deg = 1;
  EXPECT_INVALID(Terrain{options}, "sun_elevation_deg");
  options = SmallOptions();
  options.rocks.max_radius_m = 0;
  EXPECT_INVALID(Terrain{options}, "rocks.max_radius_m");
}

}  // namespace
}  // namespace arfm_vo
