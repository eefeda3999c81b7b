#include "arfm_vo/simulation/height_grid.h"

#include <gtest/gtest.h>

#include <cmath>

#include "arfm_vo/base/random.h"

namespace arfm_vo {
namespace {

HeightGrid MakeGrid(int num_cells, double cell_m, double (*height)(double, double)) {
  Raster raster(Eigen::Vector2d::Constant(-num_cells * cell_m / 2), cell_m, num_cells);
  raster.Fill(1, height);
  return HeightGrid(raster);
}

TEST(HeightGrid, VerticalAndUpwardRays) {
  const HeightGrid grid = MakeGrid(16, 1, [](double, double) { return 1.0; });
  EXPECT_NEAR(grid.Intersect({{0.25, 0.25, 5}, {0, 0, -1}}, 0, 100), 4, 1e-9);
  EXPECT_NEAR(grid.Intersect({{0, -0.0, 5}, {-0.0, 0, -2}}, 0, 100), 2, 1e-9);
  EXPECT_TRUE(std::isinf(grid.Intersect({{0.25, 0.25, 5}, {0, 0, 1}}, 0, 100)));
}

TEST(HeightGrid, RaysBesideTheSquareMeetNothing) {
  const HeightGrid grid = MakeGrid(16, 1, [](double, double) { return 1.0; });
  EXPECT_TRUE(std::isinf(grid.Intersect({{9, 0, 5}, {0, 1, -1}}, 0, 100)));
  EXPECT_TRUE(std::isinf(grid.Intersect({{-20, 0, 2}, {-1, 0, -0.1}}, 0, 100)));
}

TEST(HeightGrid, AgreesWithSmallStepsOnRoughGround) {
  const HeightGrid grid = MakeGrid(128, 0.25, [](double x, double y) {
    return std::sin(1.3 * x) * std::cos(0.9 * y) + 0.1 * x;
  });
  RandomEngine engine(1);
  for (int trial = 0; trial < 200; ++trial) {
    const auto draw = [&] { return 2 * RandomUnit(engine) - 1; };
    const Ray ray{{10 * draw(), 10 * draw(), 4},
                  {draw(), draw(), -0.05 - 0.5 * RandomUnit(engine)}};
    double expected = INFINITY;
    for (double t = 0; t < 40; t += 2e-3) {
      const Eigen::Vector3d p = ray.origin + t * ray.direction;
      if (!grid.Contains(p.x(), p.y())) break;
      if (p.z() <= grid.Height(p.x(), p.y())) {
        expected = t;
        break;
      }
    }
    const double hit = grid.Intersect(ray, 0, 40);
    if (std::isinf(expected)) {
      EXPECT_TRUE(std::isinf(hit)) << trial;
      continue;
    }
    // Never later; earlier only where the small steps jumped over a crest.
    EXPECT_LE(hit, expected + 1e-6) << trial;
    const Eigen::Vector3d p = ray.origin + hit * ray.direction;
    EXPECT_NEAR(p.z(), grid.Height(p.x(), p.y()), 1e-6) << trial;
  }
}

TEST(HeightGrid, RefusesASizeThatIsNoPowerOfTwo) {
  EXPECT_THROW(HeightGrid(Raster(Eigen::Vector2d::Zero(), 1, 12)), std::invalid_argument);
}

}  // namespace
}  // namespace arfm_vo
